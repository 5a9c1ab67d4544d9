"""What all figures of a tier will cost, before anything runs.

Of each figure: its runs, and the core-hours and the memory that `contactsim.evaluation.resources` predicts of them or,
where it
cannot, that the run of this name took at a tier where its settings now are the same. What figures share counts for each
of them, and once in their sum. Of what is not known beforehand the number of jobs is told.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from contactsim.evaluation.calibration import validation
from contactsim.evaluation.calibration.sampling import read_draws
from contactsim.evaluation.effects.effect_cost import read_ladder
from contactsim.evaluation.effects.survey import read_maps
from contactsim.evaluation.resources import START, megabytes_of, seconds_of
from contactsim.evaluation.robustness.survey import read_robustness
from contactsim.evaluation.work_precision.case_config import every_tier, read_cases
from contactsim.provenance import canonical
from contactsim.study.plan import Plan
from contactsim.study.study import Run


@dataclass(frozen=True)
class Cost:
    """What jobs will cost together.

    jobs: how many; unknown: of how many of them nothing is predicted; of the others seconds: of CPU, and megabytes: of
    the largest.
    """

    jobs: int
    unknown: int
    seconds: float = 0.0
    megabytes: float = 0.0

    @classmethod
    def of(cls, runs: Iterable[Run], plan: Plan, measured: Mapping[str, Path]) -> Cost:
        """The cost of runs: those whose results are expected to be taken over from another take their start alone.

        measured: from `all_measured`.
        """
        runs = list(runs)
        files = [measured.get(canonical(run.settings)) for run in runs]
        twins = [plan.twin(run) is not None for run in runs]
        seconds = [0.0 if twin else seconds_of(*one) for twin, *one in zip(twins, runs, files, strict=True)]
        megabytes = [megabytes_of(*one) for one in zip(runs, files, strict=True)]
        spent = sum(one + START for one in seconds if one is not None)
        largest = max((one for one in megabytes if one is not None), default=0.0)
        return cls(len(runs), sum(one is None for one in seconds), spent, largest)


def all_measured(plans: Iterable[Plan]) -> dict[str, Path]:
    """By the settings of a run, where it stands what it took; of plans of several tiers the last counts."""
    found = {}
    for plan in plans:
        for run in _runs(plan, plan.studies):
            file = plan.results / f"costs/runs/{run.stem}.json"
            if file.exists():
                found[canonical(run.settings)] = file
    return found


def by_figure(plan: Plan, measured: Mapping[str, Path]) -> dict[str, Cost]:
    """The cost of the runs that each figure shows; measured: from `all_measured`."""
    return {name: Cost.of(_runs(plan, figure.studies), plan, measured) for name, figure in plan.figures.items()}


def in_all(plan: Plan, measured: Mapping[str, Path]) -> Cost:
    """The cost of all runs that figures or claims need, each counted once; measured: from `all_measured`."""
    studies = [study for figure in plan.figures.values() for study in figure.studies]
    studies += [study for chapter in plan.claims for study in plan.claims_studies(chapter)]
    return Cost.of(_runs(plan, dict.fromkeys(studies)), plan, measured)


def others(folder: str | Path, plan: Plan) -> dict[str, int]:
    """From what is solved besides to the number of its jobs, of which nothing is predicted."""
    found = {"decisions": len({plan.decision(run) for run in _runs(plan, plan.studies)} - {None})}
    found |= {f"accuracy_{name}": len(case.jobs()) for name, case in read_cases(folder, plan).items()}
    drawn, maps = (
        read_draws(folder, plan.overrides["trials"], plan.tier),
        read_maps(folder, plan.overrides["effect_maps"], plan.tier),
    )
    stability = read_robustness(folder, plan)
    found |= {"stability": len(stability["hazards"]) if stability else 0}
    found |= {"effects": int(read_ladder(folder, plan.seed, plan.overrides["effects"], plan.tier) is not None)}
    found |= {"trials": len(validation.names(drawn)) if drawn else 0, "effect_maps": len(maps["maps"]) if maps else 0}
    return {name: jobs for name, jobs in found.items() if jobs}


def _runs(plan: Plan, studies: Iterable[str]) -> list[Run]:
    return [run for study in studies for run in plan.studies[study].runs()]


def table(folder: str | Path, plan: Plan) -> str:
    """One line for each figure, one for all their runs, and one for each of what is made besides."""
    measured = all_measured([*every_tier(folder, plan).values(), plan])
    lines = [("figure", "jobs", "core-hours", "largest job", "")]
    lines += [_line(name, cost) for name, cost in by_figure(plan, measured).items()]
    lines += [_line("all runs, each once", in_all(plan, measured))]
    lines += [_line(name, Cost(jobs, jobs)) for name, jobs in others(folder, plan).items()]
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    text = [f"{name:<{widths[0]}}{right(cells, widths[1:-1])}  {words}" for name, *cells, words in lines]
    return "".join(f"{line.rstrip()}\n" for line in text)


def right(cells: Iterable[str], widths: Iterable[int]) -> str:
    """A line of cells, each at the right of its column."""
    return "".join(f"  {cell:>{width}}" for cell, width in zip(cells, widths, strict=True))


def _line(name: str, cost: Cost) -> tuple[str, ...]:
    """A name and its cost in words."""
    if not cost.jobs:
        return name, "0", "0", "-", "solves nothing"
    if cost.unknown == cost.jobs:
        return name, f"{cost.jobs}", "unknown", "unknown", ""
    words = f"and {cost.unknown} of unknown cost" if cost.unknown else ""
    return name, f"{cost.jobs}", f"{cost.seconds / 3600:.3f}", f"{cost.megabytes / 1000:.1f} GB", words
