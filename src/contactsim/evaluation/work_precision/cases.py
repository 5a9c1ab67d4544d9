"""A case of what accuracy costs: a scene of a study, the settings at which each solver meets it, and their solution.

Its knobs, those of `contactsim.evaluation.work_precision.knobs`, are turned one at a time, with each solver that may
take it; the study's own is
the measure of the others, and solves the references. The reference of the points is a finer grid, that of the tolerance
the same grid solved far more tightly, that of the increment the same path in far smaller ones; none is on a curve.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import xarray as xr

from contactsim import dataset
from contactsim.evaluation.work_precision.knobs import Setting, SingleLoads, WholePath, kind_of, solutions
from contactsim.observables.derived import combine_runs
from contactsim.paths.driver import follow_path
from contactsim.provenance import computing_digest, digest
from contactsim.solvers.registry import is_installed, package_version, solver_module
from contactsim.study.execute import label_run
from contactsim.study.keys import ERROR_RUNS
from contactsim.study.study import Run, Study

REFERENCE = "reference"
LONG = 5.0
"""Seconds above which a setting is not timed again."""


@dataclass(frozen=True)
class Case:
    """A scene to price: its name, settings as read, the study that it belongs to, of the values to price alone."""

    name: str
    settings: dict
    study: Study

    @property
    def kind(self) -> SingleLoads | WholePath:
        """What is priced of the study."""
        return kind_of(self.study)

    @property
    def default(self) -> str:
        """The study's own solver, the measure of others."""
        return self.study.settings["solver"]["kind"]

    @property
    def selection(self) -> dict[str, list]:
        """What is priced of the study's dataset: values by dimension, those left out whole."""
        return {dataset.dimension(name): values for name, values in self.settings["vary"].items()}

    def jobs(self) -> list[str]:
        """The jobs of a case: its reference and its solvers, as far as they are installed."""
        return [REFERENCE, *filter(is_installed, self.settings["solvers"])]

    def turned(self, job: str) -> list[Setting]:
        """The settings that a job measures."""
        settled, reference = self.settings["settled"], self.settings["reference"]
        if job == REFERENCE:
            tight = {"points": {"tolerance": reference["tolerance"]}}  # a finer grid has smaller steps
            return [Setting(knob, **settled | tight.get(knob, {}) | {knob: reference[knob]}) for knob in settled]
        knobs = self.settings["solvers"][job]
        return [Setting(knob, **settled | {knob: value}) for knob in settled for value in knobs[knob]]

    def solved_by(self, job: str) -> str:
        """The solver of a job."""
        return self.default if job == REFERENCE else job

    def job_settings(self, job: str) -> dict:
        """Everything that a job's result depends on but the code."""
        kept = ("load", "members", "quantities", "settled", "reference", "repeats")
        turned = [{"knob": one.knob} | one.numbers for one in self.turned(job)]
        own = {name: self.settings[name] for name in kept} | {"turned": turned}
        runs = [run.settings for run in self.study_at(self.turned(job)[0], job).runs()]
        return {"case": self.name, "job": job, "settings": own, "runs": runs}

    def study_at(self, setting: Setting, job: str) -> Study:
        """The study of a job at one setting."""
        changed = {"points": setting.points, "tolerance": setting.tolerance, "solver": {"kind": self.solved_by(job)}}
        changed |= self.kind.changed(self.study, self.settings["load"], setting)
        apart = {"members": self.settings["members"], "fit_limits": None} | dict.fromkeys(ERROR_RUNS)
        return replace(self.study, settings=self.study.settings | changed | apart)

    def measure(self, job: str) -> tuple[xr.Dataset, list[float]]:
        """Quantities and transforms of every setting of a job, and seconds.

        Dims (setting, varied keys, member, load), of paths without the last.
        """
        found, seconds = [], []
        for setting in self.turned(job):
            runs, times = self.study_at(setting, job).runs(), []
            while len(times) < self.settings["repeats"] and not (times and times[-1] > LONG):
                parts = [(simulate_run(run), run) for run in runs]
                times.append(float(sum(data.seconds.sum() for data, _ in parts)))
            data = combine_runs(
                [
                    (label_run(data, run.settings, [""] * data.step.size), run.coordinates | {"member": run.member})
                    for data, run in parts
                ]
            )
            solved = solutions(data)
            kept = solved[[*self.settings["quantities"], "transforms", "status", *({"points_y"} & set(solved))]]
            found.append(kept.assign(setting.numbers | {"knob": setting.knob}))
            seconds.append(min(times))
        return xr.concat(found, "setting", combine_attrs="drop", coords="minimal"), seconds


def simulate_run(run: Run) -> xr.Dataset:
    """Return the simulation of a run."""
    return follow_path(run.setup)


def job_plan(case: Case, job: str) -> dict:
    """What a job depends on: its settings and its code."""
    solved_by = case.solved_by(job)
    source = computing_digest("contactsim.evaluation.work_precision.cases", solver_module(solved_by))
    return {"job": case.job_settings(job), "source": digest(source, package_version(solved_by))}
