"""Cases of the work-precision study: a study's scene, the settings of each solver, and their solution.

Knobs are varied one at a time, with each solver. The study's own solver computes the references and is the one with
which others are compared. The reference of the points is a finer grid, that of the tolerance the same grid solved far
more tightly, that of the increment the same path in far smaller ones; no reference lies on a curve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import xarray as xr

from contactsim.evaluation.figure_settings import FigureSettings
from contactsim.evaluation.work_precision.knobs import (
    Setting,
    SingleLoads,
    WholePath,
    find_case_kind,
    summarise_solutions,
)
from contactsim.observables.derived import combine_runs
from contactsim.paths.driver import follow_path
from contactsim.provenance import digest
from contactsim.solvers.registry import is_installed, package_version, solver_module
from contactsim.study.execute import label_run
from contactsim.study.keys import ERROR_RUNS
from contactsim.study.run import Run
from contactsim.study.stages import computing_stage_digest
from contactsim.study.study import Study
from contactsim.variables import dimension_name

REFERENCE = "reference"
MAX_REPEATED_SECONDS = 5.0
"""Seconds above which a setting is not timed again."""


@dataclass(frozen=True)
class CaseSettings(FigureSettings):
    """Settings of a case, in the order of `case_config.CASE_KEYS`.

    Parameters
    ----------
    study : str
        Name of the study.
    vary : mapping
        Selected values by key that the study varies.
    load : sequence of float or None
        Selected loads; None where the study follows a path.
    members : int
        Members of the ensemble of each setting.
    quantities : sequence of str
        Quantities whose errors are measured.
    settled, reference : mapping
        The value of each knob at which the others are turned, and in the references.
    solvers : mapping
        The values of each knob by solver.
    levels : mapping
        Errors at which solvers are compared, by knob.
    repeats : int
        How often each setting is timed.
    thesis_members, thesis_increment : int and float, or None
        The thesis's own numbers.
    """

    study: str
    vary: Mapping[str, list]
    load: Sequence[float] | None
    members: int
    quantities: Sequence[str]
    settled: Mapping[str, float]
    reference: Mapping[str, float]
    solvers: Mapping[str, Mapping[str, Sequence[float]]]
    levels: Mapping[str, Sequence[float]]
    repeats: int
    thesis_members: int | None
    thesis_increment: float | None


@dataclass(frozen=True)
class Case:
    """A case of the work-precision study.

    Parameters
    ----------
    name, settings
        Its name and its settings.
    study
        Its study, restricted to the selected values.
    kept
        Date of measurement by solver, for solvers whose results the package contains.
    """

    name: str
    settings: CaseSettings
    study: Study
    kept: Mapping[str, str] = field(default_factory=dict)

    @property
    def kind(self) -> SingleLoads | WholePath:
        """Return the kind of the study's solutions, with their knobs and quantities."""
        kind = find_case_kind(self.study)
        assert kind is not None, "a study of another kind is refused when its case is read"
        return kind

    @property
    def default(self) -> str:
        """Return the study's own solver, with which others are compared."""
        return self.study.settings["solver"]["kind"]

    @property
    def selection(self) -> dict[str, list]:
        """Return the selected values of the study's dataset by dimension; other dimensions count whole."""
        return {dimension_name(name): values for name, values in self.settings.vary.items()}

    @property
    def baselines(self) -> list[str]:
        """Return the solvers that are compared with the study's own, installed or not."""
        return [solver for solver in self.settings.solvers if solver != self.default]

    def jobs(self) -> list[str]:
        """Return the jobs of a case: its reference and its installed solvers, without those that are kept."""
        return [job for job in self.shown_jobs() if job not in self.kept]

    def shown_jobs(self) -> list[str]:
        """Return the jobs that the figure shows: the reference and each solver that is kept or installed."""
        return [REFERENCE, *(name for name in self.settings.solvers if name in self.kept or is_installed(name))]

    def settings_of(self, job: str) -> list[Setting]:
        """Return the settings that a job measures."""
        settled: dict[str, Any] = dict(self.settings.settled)
        reference = self.settings.reference
        if job == REFERENCE:
            tight = {"points": {"tolerance": reference["tolerance"]}}  # a finer grid has smaller steps
            return [Setting(knob, **settled | tight.get(knob, {}) | {knob: reference[knob]}) for knob in settled]
        knobs = self.settings.solvers[job]
        return [Setting(knob, **settled | {knob: value}) for knob in settled for value in knobs[knob]]

    def solver_of(self, job: str) -> str:
        """Return the solver of a job."""
        return self.default if job == REFERENCE else job

    def job_settings(self, job: str) -> dict[str, Any]:
        """Return what a job's result depends on, apart from the code."""
        names = ("load", "members", "quantities", "settled", "reference", "repeats")
        places = [{"knob": setting.knob} | setting.numbers for setting in self.settings_of(job)]
        settings = self.settings.settings
        own = {name: settings[name] for name in names} | {"turned": places}
        runs = [run.settings for run in self.study_at(self.settings_of(job)[0], job).runs()]
        return {"case": self.name, "job": job, "settings": own, "runs": runs}

    def study_at(self, setting: Setting, job: str) -> Study:
        """Return the study of a job at one setting."""
        edits = {"points": setting.points, "tolerance": setting.tolerance, "solver": {"kind": self.solver_of(job)}}
        edits |= self.kind.edit_settings(self.study, self.settings.load, setting)
        edits |= {"members": self.settings.members, "fit_limits": None} | dict.fromkeys(ERROR_RUNS)
        return replace(self.study, settings=self.study.settings | edits)

    def measure(self, job: str) -> tuple[xr.Dataset, list[float]]:
        """Solve every setting of a job.

        Returns
        -------
        data : xarray.Dataset
            Quantities, transforms and statuses, dimensions (setting, varied keys, member, load); paths have no load.
        seconds : list of float
            Shortest CPU time of each setting.
        """
        results, seconds = [], []
        for setting in self.settings_of(job):
            runs = self.study_at(setting, job).runs()
            times: list[float] = []
            while len(times) < self.settings.repeats and not (times and times[-1] > MAX_REPEATED_SECONDS):
                parts = [(simulate_run(run), run) for run in runs]
                times.append(float(sum(data.seconds.sum() for data, _ in parts)))
            data = combine_runs(
                [
                    (label_run(data, run.settings, [""] * data.step.size), run.coordinates | {"member": run.member})
                    for data, run in parts
                ]
            )
            summary = summarise_solutions(data)
            result = summary[[*self.settings.quantities, "transforms", "status", *({"points_y"} & set(summary))]]
            results.append(result.assign(setting.numbers | {"knob": setting.knob}))
            seconds.append(min(times))
        return xr.concat(results, "setting", combine_attrs="drop", coords="minimal"), seconds


def simulate_run(run: Run) -> xr.Dataset:
    """Return the simulation of a run."""
    return follow_path(run.setup)


def case_job(case: Case, job: str) -> dict[str, Any]:
    """Return what a job depends on: its settings and its code."""
    solver = case.solver_of(job)
    source = computing_stage_digest("work_precision", solver_module(solver))
    return {"job": case.job_settings(job), "source": digest(source, package_version(solver))}
