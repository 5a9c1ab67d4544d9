"""One job of a study: the values that it depends on, and the digests of these and of the code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from contactsim.elasticity.registry import ELASTICITIES
from contactsim.interface.registry import EFFECTS, PAIRINGS
from contactsim.paths.driver import driver_module
from contactsim.paths.increments import INCREMENTS
from contactsim.paths.options import Setup
from contactsim.provenance import digest
from contactsim.solvers.registry import solver_module
from contactsim.study.kinds import problem_kind
from contactsim.study.scenes import build_setup
from contactsim.study.stages import computing_stage_digest, run_digest
from contactsim.surfaces.registry import SURFACES

KINDS: dict[str, Mapping[str, type]] = {
    "surface": SURFACES,
    "body": ELASTICITIES,
    "counter_body": ELASTICITIES,
    "pairing": PAIRINGS,
    "increments": INCREMENTS,
}
"""Classes by kind, for each section of the settings that has one; rigid bodies have none."""


@dataclass(frozen=True)
class Run:
    """One job of a study.

    Parameters
    ----------
    study, variant : str
        Names of the study and of the variant.
    member : int
        Number in the ensemble.
    coordinates : dict
        Varied values by dimension of the study's dataset.
    settings : dict
        Every value that the run depends on.
    error : str
        Kind of error that it measures, of `keys.ERROR_RUNS`; empty for the study's own runs.
    """

    study: str
    variant: str
    member: int
    coordinates: dict[str, object]
    settings: dict
    error: str = ""

    @property
    def measures_error(self) -> bool:
        """True where it only measures an error."""
        return bool(self.error)

    @cached_property
    def setup(self) -> Setup:
        """Scene and options."""
        return build_setup(self.settings)

    @property
    def stage(self) -> str:
        """Stage of the workflow that computes it, of `stages.STAGES`."""
        if "auto" in self.settings:
            return "run_neglecting"
        return "run_to_accuracy" if "accuracy" in self.settings else "run"

    @cached_property
    def source(self) -> str:
        """Digest of the code that computes the run, the libraries.

        Code are the modules of its solver and of the kinds that it names, and all that these use. A run that chooses
        its settings by itself may come to any kind.
        """
        solver = solver_module(self.settings["solver"]["kind"])
        if self.stage == "run":
            return run_digest(solver, *modules_of_kinds(self.settings))
        return computing_stage_digest(self.stage, solver)

    @cached_property
    def digest(self) -> str:
        """Digest of the settings and of the code that computes the run."""
        return digest(self.settings, self.source)

    @property
    def stem(self) -> str:
        """Path of the run's files below runs/ and costs/runs/, without their endings."""
        return f"{self.study}/{self.variant}/{self.member}"


def modules_of_kinds(settings: Mapping) -> tuple[str, ...]:
    """Return the modules of all kinds that a run names, and that of its kind of problem."""
    named = {EFFECTS[name].__module__ for name in settings["effects"]}
    for section, classes in KINDS.items():
        kind = (settings.get(section) or {}).get("kind", "")
        named |= {classes[kind].__module__} if kind in classes else set()
    return driver_module(problem_kind(settings["effects"])), *sorted(named)
