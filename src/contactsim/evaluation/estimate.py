"""Estimate the cost of all figures of a tier before anything runs.

The core-hours and memory of a run are predicted by `contactsim.evaluation.resources`. Where they cannot be predicted,
the costs of a run with the same settings at any tier count. Runs that several figures share count for each of them,
and once in the sum.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from contactsim.evaluation.calibration.settings import read_trials
from contactsim.evaluation.effects.effect_cost import read_variants
from contactsim.evaluation.effects.map_settings import read_maps
from contactsim.evaluation.resources import START_SECONDS, predict_megabytes, predict_seconds
from contactsim.evaluation.robustness.survey import read_robustness
from contactsim.evaluation.work_precision.case_config import read_all_tiers, read_cases
from contactsim.provenance import canonical
from contactsim.study.plan import Plan
from contactsim.study.run import Run


@dataclass(frozen=True)
class Cost:
    """The cost of jobs together.

    Parameters
    ----------
    jobs : int
        Number of jobs.
    unknown : int
        Number of jobs without prediction; they count in nothing below.
    seconds : float
        CPU seconds of all jobs.
    megabytes : float
        Memory of the largest job.
    """

    jobs: int
    unknown: int
    seconds: float = 0.0
    megabytes: float = 0.0

    @classmethod
    def of(cls, runs: Iterable[Run], plan: Plan, measured: Mapping[str, Path]) -> Cost:
        """Return the cost of runs; a run that takes over the results of another costs its start alone.

        Parameters
        ----------
        runs : iterable of Run
            The runs.
        plan : Plan
            The plan that they belong to.
        measured : mapping
            From `find_measured_costs`.
        """
        runs = list(runs)
        files = [measured.get(canonical(run.settings)) for run in runs]
        twins = [plan.twin(run) is not None for run in runs]
        seconds = [
            0.0 if twin else predict_seconds(run, file) for run, file, twin in zip(runs, files, twins, strict=True)
        ]
        megabytes = [predict_megabytes(*run) for run in zip(runs, files, strict=True)]
        total = sum(time + START_SECONDS for time in seconds if time is not None)
        largest = max((size for size in megabytes if size is not None), default=0.0)
        return cls(len(runs), sum(time is None for time in seconds), total, largest)


def find_measured_costs(plans: Iterable[Plan]) -> dict[str, Path]:
    """Return the files of measured costs by the JSON of a run's settings; later plans replace earlier ones."""
    files = {}
    for plan in plans:
        for run in _runs(plan, plan.studies):
            file = plan.results / f"costs/runs/{run.stem}.json"
            if file.exists():
                files[canonical(run.settings)] = file
    return files


def figure_costs(plan: Plan, measured: Mapping[str, Path]) -> dict[str, Cost]:
    """Return the cost of each figure's runs by name; measured: from `find_measured_costs`."""
    return {name: Cost.of(_runs(plan, figure.studies), plan, measured) for name, figure in plan.figures.items()}


def total_cost(plan: Plan, measured: Mapping[str, Path]) -> Cost:
    """Return the cost of all runs for figures and claims, each counted once; measured: from `find_measured_costs`."""
    studies = [study for figure in plan.figures.values() for study in figure.studies]
    studies += [study for chapter in plan.claims for study in plan.claims_studies(chapter)]
    return Cost.of(_runs(plan, dict.fromkeys(studies)), plan, measured)


def count_other_jobs(folder: str | Path, plan: Plan) -> dict[str, int]:
    """Return the numbers of other jobs by name; their costs are not predicted."""
    counts = {"decisions": len({plan.decision(run) for run in _runs(plan, plan.studies)} - {None})}
    counts |= {f"accuracy_{name}": len(case.jobs()) for name, case in read_cases(folder, plan).items()}
    trials, maps = (
        read_trials(folder, plan.overrides["trials"], plan.tier),
        read_maps(folder, plan.overrides["effect_maps"], plan.tier),
    )
    stability = read_robustness(folder, plan)
    counts |= {"stability": len(stability.hazards) if stability else 0}
    counts |= {"effects": int(read_variants(folder, plan.seed, plan.overrides["effects"], plan.tier) is not None)}
    counts |= {
        "trials": len(trials.names(trials.trial)) if trials else 0,
        "effect_maps": len(maps.maps) if maps else 0,
    }
    return {name: jobs for name, jobs in counts.items() if jobs}


def _runs(plan: Plan, studies: Iterable[str]) -> list[Run]:
    """Return all runs of studies."""
    return [run for study in studies for run in plan.studies[study].runs()]


def cost_table(folder: str | Path, plan: Plan) -> str:
    """Return the costs as text: a line for each figure, one for all runs, and one for each group of other jobs."""
    measured = find_measured_costs([*read_all_tiers(folder, plan).values(), plan])
    lines = [("figure", "jobs", "core-hours", "largest job", "")]
    lines += [_cost_row(name, cost) for name, cost in figure_costs(plan, measured).items()]
    lines += [_cost_row("all runs, each once", total_cost(plan, measured))]
    lines += [_cost_row(name, Cost(jobs, jobs)) for name, jobs in count_other_jobs(folder, plan).items()]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    text = [f"{name:<{widths[0]}}{align_right(cells, widths[1:-1])}  {words}" for name, *cells, words in lines]
    return "".join(f"{line.rstrip()}\n" for line in text)


def align_right(cells: Iterable[str], widths: Iterable[int]) -> str:
    """Return a line of cells, each aligned right in its column."""
    return "".join(f"  {cell:>{width}}" for cell, width in zip(cells, widths, strict=True))


def _cost_row(name: str, cost: Cost) -> tuple[str, str, str, str, str]:
    """Return a name and the cells of its cost."""
    if not cost.jobs:
        return name, "0", "0", "-", "solves nothing"
    if cost.unknown == cost.jobs:
        return name, f"{cost.jobs}", "unknown", "unknown", ""
    words = f"and {cost.unknown} of unknown cost" if cost.unknown else ""
    return name, f"{cost.jobs}", f"{cost.seconds / 3600:.3f}", f"{cost.megabytes / 1000:.1f} GB", words
