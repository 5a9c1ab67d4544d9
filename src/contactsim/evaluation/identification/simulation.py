"""Simulate a candidate for the cell of the probe: all interfaces, and the strong one in twice the period."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.steps import LoadStep
from contactsim.evaluation.identification.sampling import Candidate
from contactsim.observables.adhesion import contact_length
from contactsim.observables.dataset_forms import form_of
from contactsim.observables.derived import combine_runs
from contactsim.observables.friction import ONSET
from contactsim.observables.threshold import APPROACH_ERROR, THRESHOLD
from contactsim.paths.driver import follow_path
from contactsim.paths.increments import Increments
from contactsim.paths.jumps import Jump
from contactsim.paths.requested import Requested
from contactsim.paths.state import PathState
from contactsim.reference import adhesion
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.study.run import Run
from contactsim.study.study import Study
from contactsim.study.tier_overrides import overlaid
from contactsim.variables import GRID_CHANGE

RADIUS_PER_WIDTH = 2.5
"""R/w of the text."""
START = -10.0
"""δ0 of the text: the approach (nm from touch) from which the probe is pressed."""
REFERENCE_CONTACT, REFERENCE_RADIUS = 1100.0, 25000.0
"""Contact length at the largest approach in Chapter 4's cell, and its radius, nm; they bound the length of a slide."""
DOUBLED = "doubled"
"""Name of the dataset of the strong interface in twice the period."""
STORED = (
    *ONSET,
    *(f"{name}_increment_error" for name in ONSET),
    *THRESHOLD,
    *(f"{name}{APPROACH_ERROR}" for name in THRESHOLD),
    *("points", "length", "lattice_constant", "status", "line_load", "sliding_distance"),
)
"""Variables that are kept of a candidate."""


@dataclass(frozen=True)
class RunSettings:
    """Grid, increments and ends of the slides of all candidates; the keys of `runs` in config/identification.yaml."""

    approaches: Sequence[float]
    spacing: float
    points: int
    increment: float
    fold_width: float
    tolerance: float
    flow_step: float
    slips: int

    def grid(self, width: float) -> int:
        """Return the number of points of a cell: a power of two."""
        return max(self.points, 2 ** math.ceil(math.log2(width / self.spacing)))


@dataclass(frozen=True)
class UntilReattached:
    """The increments of another way, up to some slips at which the contact grows, or twice as many slips."""

    increments: Increments
    slips: int

    @property
    def needs_period(self) -> bool:
        """True where the other way needs heights that repeat."""
        return self.increments.needs_period

    def check(self, points: int, steps: Sequence[LoadStep], solver: CohesiveSolver) -> None:
        """Check as the other way does."""
        self.increments.check(points, steps, solver)

    def follow(
        self, problem: CohesiveProblem, solver: CohesiveSolver, steps: Sequence[LoadStep]
    ) -> Iterator[PathState]:
        """Yield the states at the steps, in order, up to the end."""
        slips = grown = 0
        for state in self.increments.follow(problem, solver, steps):
            yield state
            held = [jump for jump in state.jumps if jump.step.held]
            slips += len(held)
            grown += sum(_grows(jump) for jump in held)
            if grown >= self.slips or slips >= 2 * self.slips:
                return


def _grows(slip: Jump) -> bool:
    """Return True if the contact grows at a slip."""
    return contact_length(slip.after.gap[0], 1.0) > contact_length(slip.before.gap[0], 1.0)


@dataclass(frozen=True)
class CandidateJob:
    """One candidate with the studies of its interfaces.

    Parameters
    ----------
    candidate
        The cell.
    sections
        Section of the config of each interface; the first is the strong one.
    runs
        Grid and increments.
    seed
        Seed of the studies.
    tier
        Name of the tier.
    """

    candidate: Candidate
    sections: Mapping[str, Mapping[str, Any]]
    runs: RunSettings
    seed: int
    tier: str

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> CandidateJob:
        """Return the job from its JSON."""
        return cls(
            Candidate(**settings["candidate"]),
            settings["sections"],
            RunSettings(**settings["runs"]),
            settings["seed"],
            settings["tier"],
        )

    @property
    def settings(self) -> dict[str, Any]:
        """The job as it is written to JSON."""
        return asdict(self)

    def study(self, interface: str, periods: int = 1, grid: float = 1.0) -> Study:
        """Return the study of an interface.

        Parameters
        ----------
        interface
            Name of its section.
        periods
            Factor of the period at the same radius; longer ones do not slide on, as their load before is wanted.
        grid
            Factor of the points.
        """
        cell, runs = self.candidate, self.runs
        reach = 2 * runs.increment if periods > 1 else slide_reach(cell, self.sections[interface], runs)
        over = {
            "surface": {"radius": RADIUS_PER_WIDTH * cell.width, "length": periods * cell.width},
            "counter_body": {"thickness": cell.thickness},
            "pairing": {"lattice_constant": cell.lattice_constant},
            "vary": {"slide.approach": list(runs.approaches)},
            "path": {"approach": [START - 1.0, START], "increment": 1.0},
            "slide": {"through": [0.0, reach], "increment": runs.increment},
            "increments": {"kind": "requested", "fold_width": runs.fold_width},
            "points": round(grid * periods * runs.grid(cell.width)),
            "tolerance": runs.tolerance,
            "solver": {"kind": "newton", "flow_step": runs.flow_step},
            "coarse_grid": None,
        }
        section = {key: value for key, value in self.sections[interface].items() if key not in ("increments", "vary")}
        return Study.read(interface, overlaid(section, over), "identification.yaml", self.seed)


def slide_reach(cell: Candidate, section: Mapping[str, Any], runs: RunSettings) -> float:
    """Return a sliding distance (nm) after which a slide ends, with or without slips: a bound on onset and periods.

    At the onset the force is at most strength times contact; a half-space as deep as the layer gives way by it.
    """
    law, body = section["cohesive_zone"], section["counter_body"]
    work = law["work_of_separation"] * law["work_ratio"]
    strength = float(adhesion.tangential_strength(work, law["tangential_length"], 0.0))
    contact = REFERENCE_CONTACT * math.sqrt(RADIUS_PER_WIDTH * cell.width / REFERENCE_RADIUS)
    modulus = body["youngs_modulus"] / (1 - body["poisson_ratio"] ** 2)
    depth = max(math.log(8 * cell.thickness / contact), 1.0)
    onset = strength * contact * 2 / (math.pi * modulus) * depth
    reach = onset + (runs.slips + 2) * cell.lattice_constant
    return math.ceil(reach / runs.increment) * runs.increment


def simulate_candidate(job: CandidateJob) -> dict[str, xr.Dataset]:
    """Return the dataset of each interface by its name, and that of the strong one in twice the period."""
    data = {}
    for interface in job.sections:
        fine = _summaries(job.study(interface), job.runs.slips)
        coarse = _summaries(job.study(interface, grid=0.5), job.runs.slips)
        data[interface] = with_grid_change(fine, coarse)
    study = job.study(next(iter(job.sections)), periods=2)
    data[DOUBLED] = _summaries(study, job.runs.slips)
    return {name: _stamped(part, name, job) for name, part in data.items()}


def _summaries(study: Study, slips: int) -> xr.Dataset:
    """Return the slides of a study with their summaries."""
    runs = [(_slide(run, slips), run.coordinates | {"member": run.member}) for run in study.runs()]
    combined = combine_runs(runs)
    data = form_of(combined).derive(combined)
    data = data[[name for name in STORED if name in data]]
    data.attrs["study"] = study.settings
    return data


def _slide(run: Run, slips: int) -> xr.Dataset:
    """Return the slide of one run, up to its last slip that counts."""
    options = run.setup.options
    setup = run.setup.with_options(increments=UntilReattached(options.increments or Requested(), slips))
    data = follow_path(setup).drop_vars("seconds")
    return data.assign_coords(step=np.arange(data.step.size))


def with_grid_change(fine: xr.Dataset, coarse: xr.Dataset) -> xr.Dataset:
    """Return slides with the change of their summaries from those on half the points."""
    names = [name for name in (*ONSET, *THRESHOLD) if name in fine and name in coarse]
    return fine.assign({f"{name}{GRID_CHANGE}": fine[name] - coarse[name] for name in names})


def _stamped(data: xr.Dataset, name: str, job: CandidateJob) -> xr.Dataset:
    """Return a dataset with units and the settings that its study has."""
    settings = data.attrs.pop("study") | {"name": name, "tier": job.tier, "seed": job.seed}
    return dataset.stamp(dataset.describe(data), f"{name} of {job.candidate.name}", settings, "")
