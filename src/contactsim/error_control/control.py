"""A run to an accuracy: solved on two grids, the error estimated, and refined once where it is missed.

The coarser companion comes first. At a hard wall it says how small the contacts are, from which the grid of the run
follows better than from any relation, and its pressure is where the cascade of the run begins; of a path it has
three times the increments too, so that what differs is what all knobs together leave open. The estimate
is the larger of that change, as it shrinks with the order of convergence, and of what is expected of such a grid:
changes may vanish by chance.
"""

from __future__ import annotations

import logging
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.error_control.options import SAFETY, chosen, coarser, left_open, on_grid, on_points, rescaled
from contactsim.error_control.scaling import MEASURES, ORDERS, SECOND, Kind, kind_of, relations
from contactsim.grid import Array
from contactsim.observables.derived import combine_runs, summarise_paths
from contactsim.solvers.registry import make_solver
from contactsim.status import is_solved
from contactsim.study.execute import asked_of, keep, names_of, simulate
from contactsim.study.keys import is_smooth
from contactsim.study.scenes import scene_of

logger = logging.getLogger(__name__)

MOST = {1: 8.0, 2: 4.0}
"""How many times finer a run may be than its companion, or a refined one than the first, by dimension."""
TRUST = 0.7
"""Part of a change that counts: the coarser run is often too coarse to be of any order, and makes it large."""
TINY = 1e-9
"""Least part of a contact that counts as its edge."""
BLIND = 2.0
"""How much finer a grid is made where nothing is known of the error."""
LEAST = 1.25
"""How much finer a refined grid is at least."""


@dataclass(frozen=True)
class Outcome:
    """One solution of a run: its settings, dataset, values by quantity, one of each load or of the path as a whole.

    resolved: pairs of neighbours at an edge over points in contact, by load; empty of smooth laws.
    """

    settings: dict
    data: xr.Dataset
    values: dict[str, Array]
    resolved: Array

    @property
    def points(self) -> int:
        """Of the grid along x."""
        return self.settings["points"]

    @property
    def solved(self) -> bool:
        """Whether every state has converged."""
        return bool(is_solved(self.data.status).all())

    @property
    def transforms(self) -> float:
        """Of all steps, in those of its own grid."""
        return float(self.data.transforms.sum())

    @property
    def seconds(self) -> float:
        """CPU seconds of all steps."""
        return float(self.data.seconds.sum())

    @property
    def size(self) -> int:
        """All points of the grid."""
        return self.points * int(self.data.get("points_y", 1))


def outcome(settings: dict, names: Sequence[str], threads: int = 1, begun: Outcome | None = None) -> Outcome:
    """A run's settings simulated as they are; names: of the quantities read off it.

    begun: the same at a wall on a coarser grid with its fields, from which the solver's cascade begins.
    """
    asked = asked_of(settings)
    if begun is not None and "pressure" in begun.data:
        asked["begun"] = begun.data
    data = simulate(
        scene_of(settings),
        points=settings["points"],
        tolerance=settings["tolerance"],
        method=make_solver(**settings["solver"]),
        threads=threads,
        **asked,
    )
    if is_smooth(settings):
        whole = summarise_paths(combine_runs([(data.drop_vars("seconds"), {"member": 0})])).isel(member=0)
        return Outcome(
            settings, data, {name: np.atleast_1d(whole[name].values.astype(float)) for name in names}, np.empty(0)
        )
    values = {name: data[name].values.astype(float) for name in names}
    resolved = data.contact_edges.values / np.maximum(data.contact_points.values, 1)
    return Outcome(settings, data, values, resolved)


def difference(one: Outcome, two: Outcome, name: str) -> Array:
    """Size of the change of a quantity from one solution to another, over the first's: of each load, or of the path.

    Zero where both are equal or neither has it, as a path without a pull-off; infinite where one alone has it, where
    only the first is zero, and everywhere if a state of either has not converged.
    """
    if not (one.solved and two.solved):
        return np.full(one.values[name].shape, np.inf)
    first, second = one.values[name], two.values[name]
    found, missing = np.full(first.shape, np.inf), np.isnan(first) | np.isnan(second)
    np.divide(np.abs(second - first), np.abs(first), out=found, where=~missing & (first != 0))
    return np.where((np.isnan(first) & np.isnan(second)) | (first == second), 0.0, found)


@dataclass(frozen=True)
class Reached:
    """What came of an accuracy that was asked for.

    last: the final run; before: what was solved before it, the companion of the last estimate last; errors: relative,
    as estimated, by quantity, of each load or of the path.
    """

    last: Outcome
    before: list[Outcome]
    errors: dict[str, Array]
    asked: float

    @property
    def met(self) -> bool:
        """Whether every estimate is within what was asked for."""
        return all(bool((values <= self.asked).all()) for values in self.errors.values())

    @property
    def data(self) -> xr.Dataset:
        """The last run's dataset, with the error of each quantity as estimated and what was solved before."""
        found = self.last.data
        for name, values in self.errors.items():
            sizes = values * np.abs(self.last.values[name])
            found = found.assign({f"{name}_estimated_error": ("step", sizes) if name in found else float(sizes[0])})
        spent = sum(one.seconds for one in self.before)
        seconds = found.seconds.values + spent * (np.arange(found.step.size) == 0)
        found = found.assign(
            accuracy=self.asked,
            reached=int(self.met),
            points_before=self.before[-1].points,
            refinements=len(self.before) - 1,
            transforms_before=self.work - self.last.transforms,
            seconds=("step", seconds),
        )
        return dataset.described(found)

    @property
    def work(self) -> float:
        """Transforms of all runs, in those of the last one's grid."""
        return sum(one.transforms * one.size for one in [*self.before, self.last]) / self.last.size

    @property
    def seconds(self) -> float:
        """CPU seconds of all runs."""
        return sum(one.seconds for one in [*self.before, self.last])


def reach(settings: dict, error: float, of: Sequence[str] = (), threads: int = 1) -> Reached:
    """Solve a run's scene to a relative error of quantities, as it is estimated; the grid given is of no account."""
    first = chosen(settings, error, of)
    scene = scene_of(first)
    kind = kind_of(scene)
    known, names = relations().kinds[kind], tuple(of or MEASURES[kind])
    companion = coarser(first)
    if "keep" in companion:
        companion = companion | {"keep": ["fields"]}
    before = [outcome(companion, names, threads)]
    settings = _after(first, before[0], known, names, error)
    last = outcome(settings, names, threads, before[0])
    errors = estimated(last, before[0], known, names)
    logger.info("on %d points, after %d: %s", last.points, before[0].points, _told(errors, error))
    if any(not (values <= error).all() for values in errors.values()):
        before.append(last)
        settings = _refined(last, errors, error)
        last = outcome(settings, names, threads, before[0])
        errors = estimated(last, before[1], known, names)
        logger.info("refined to %d points: %s", last.points, _told(errors, error))
    return Reached(last, before, errors, error)


def estimated(fine: Outcome, coarse: Outcome, known: Kind, names: Sequence[str]) -> dict[str, Array]:
    """Relative errors of a run, by quantity: what its knobs leave open, and its change from a coarser one.

    A change shrinks as the relations say that errors do between the two.
    """
    found = {}
    for name in names:
        left, before = _expected(fine, known, name), _expected(coarse, known, name)
        changes = difference(fine, coarse, name) * left / np.maximum(before - left, left)
        found[name] = np.maximum(TRUST * changes, left)
    return found


def _expected(run: Outcome, known: Kind, name: str) -> Array:
    """The relative error that grid and increments leave.

    At a wall both by what is known of such scenes and by how well the contacts that were found are shown: their mean.
    """
    places = on_grid(scene_of(run.settings), run.points)
    if name in known.resolved:
        seen = [one | {"resolved": math.log(max(x, TINY))} for one, x in zip(places, run.resolved, strict=True)]
        return np.array([math.sqrt(known.resolved[name](one) * known.errors["points"][name](one)) for one in seen])
    return np.array([left_open(run.settings, known, name)])


def _after(settings: dict, companion: Outcome, known: Kind, names: Sequence[str], error: float) -> dict:
    """The settings of a run after its companion: at a wall on the grid for contacts as small as those it found."""
    if not companion.resolved.size:
        return settings
    finest = 1.0  # what follows from the companion
    for name in names:
        off = _expected(companion, known, name).max()
        finest = max(finest, (off / (SAFETY[kind_of(scene_of(settings))] * error)) ** (1 / ORDERS.get(name, SECOND)))
    return on_points(settings, companion.points * min(max(finest, 2.0), _most(companion)), error)


def _refined(run: Outcome, errors: dict[str, Array], error: float) -> dict:
    """The settings of a run that missed: a finer grid by as much as the estimates say, and half the increments."""
    wanted = SAFETY[kind_of(scene_of(run.settings))] * error
    worst = {name: float(values.max()) for name, values in errors.items()}
    found = [
        BLIND if np.isinf(one) else (one / wanted) ** (1 / ORDERS.get(name, SECOND)) for name, one in worst.items()
    ]
    finer = max(found)
    settings = run.settings | (rescaled(run.settings, 0.5) if is_smooth(run.settings) else {})
    return on_points(settings, run.points * float(np.clip(finer, LEAST, _most(run))), error)


def _most(run: Outcome) -> float:
    return MOST[2 if "points_y" in run.data else 1]


def _told(errors: dict[str, Array], asked: float) -> str:
    """The estimates in words."""
    return ", ".join(f"{name} to {values.max():.2g} of {asked:g}" for name, values in errors.items())


def run(
    settings: dict,
    source: str,
    target: str | Path,
    costs: str | Path,
    threads: int = 1,
    told: Mapping[str, object] | None = None,
) -> None:
    """Compute a run to the accuracy that its settings ask for, into its dataset and costs; see `march.run`."""
    begin = time.process_time()
    found = reach(settings, **settings["accuracy"], threads=threads)
    final = found.last.settings
    if not found.met:
        logger.warning("an accuracy of %g is not reached: %s", found.asked, _told(found.errors, found.asked))
    keep(found.data.assign(told or {}), final, names_of(final, source), source, (target, costs), begin)
