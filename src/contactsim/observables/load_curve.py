"""A path as a curve of load against approach, through its states and both sides of its jumps.

A smooth branch ends at a fold, where the surface jumps to another branch. The fold lies between the last state before
the jump and the first one after it; the distance between these is the width of the jump.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from contactsim.grid import Array
from contactsim.status import is_solved

FOLD = (
    "fold_step",
    *("fold_approach_peak_before", "fold_approach_before", "fold_approach_after", "fold_approach_peak_after"),
    *("fold_load_peak_before", "fold_load_before", "fold_load_after", "fold_load_peak_after"),
)
"""Numbers of each jump on a path of approach or load, on a line: on both sides, and at the largest pulls, within the
step of the path, of the branches that end and begin there."""


@dataclass(frozen=True)
class CurveNames:
    """Names of the numbers of which a curve consists, and of those that are read off it.

    Attributes
    ----------
    load
        The load of a state.
    folds
        Numbers of each jump.
    word
        What the load is called in the names of the numbers that are read off.
    """

    load: str
    folds: tuple[str, ...]
    word: str


CURVES = {
    1: CurveNames("line_load", FOLD, "load"),
    2: CurveNames(
        "normal_force",
        (*FOLD[:5], "fold_force_peak_before", "fold_force_before", "fold_force_after", "fold_force_peak_after"),
        "force",
    ),
}
"""By the number of dimensions: a load is that of a unit of thickness, N/m, a force that of a surface, nN."""
PARABOLA_SAFETY = 2.0
"""Least error of a smooth extreme over the change that a parabola makes: the curve bends more towards a fold."""
ROUNDING = 1e-9
"""Difference of approach (nm) up to which a side of a jump is the state beside it."""


@dataclass(frozen=True)
class LoadCurve:
    """Load against approach through the states of a path and both sides of its jumps.

    Attributes
    ----------
    approach, load
        Approach (nm) and load (N/m, on a surface nN; NaN where there is no solution), (place,).
    width
        Change of approach over the jump that ends at a place, nm; zero where none does, (place,).
    is_state
        True at a state that the path was asked for, (place,).
    """

    approach: Array
    load: Array
    width: Array
    is_state: Array

    @classmethod
    def from_states(cls, approach: Array, load: Array, jump: Array, folds: Sequence[Array] = ()) -> LoadCurve:
        """Return the curve through the states and the folds that are known.

        Parameters
        ----------
        approach, load, jump
            Approach, nm, load, and distance that the surface jumped since the step before, nm, (step,).
        folds
            Numbers of the jumps in the order of `FOLD`, each (fold,); NaN where there is none. A jump without them lies
            anywhere in its step.
        """
        width = np.where(jump > 0, np.abs(np.diff(approach, prepend=approach[:1])), 0.0)
        places: list[int] = []
        inserted: list[tuple[float, float, float]] = []
        for number, peak, before, after, peak_after, *loads in zip(*folds, strict=True):
            if np.isnan(number):
                continue
            step = int(number)
            last = inserted[-1][0] if places and places[-1] == step else approach[step - 1]
            if min(abs(peak - last), abs(peak - before)) > ROUNDING:
                inserted.append((peak, loads[0], 0.0))
            if abs(before - last) > ROUNDING:
                inserted.append((before, loads[1], 0.0))
            is_inside = abs(after - approach[step]) > ROUNDING
            if is_inside:
                inserted.append((after, loads[2], abs(after - before)))
            if is_inside and min(abs(peak_after - after), abs(peak_after - approach[step])) > ROUNDING:
                inserted.append((peak_after, loads[3], 0.0))
            width[step] = 0.0 if is_inside else abs(after - before)
            places += [step] * (len(inserted) - len(places))
        columns = np.array(inserted, float).reshape(-1, 3).T
        values = [np.insert(row, places, column) for row, column in zip((approach, load, width), columns, strict=True)]
        return cls(values[0], values[1], values[2], np.insert(np.ones(approach.size, bool), places, False))

    def part(self, places: slice) -> LoadCurve:
        """Return a part of the curve."""
        return LoadCurve(self.approach[places], self.load[places], self.width[places], self.is_state[places])

    def extreme_errors(self, place: int) -> tuple[float, float]:
        """Return what the increments leave open of an extreme load and of its approach (nm).

        The place has others on both sides. Beside a jump the extreme may lie anywhere within its width. After a jump
        the branch is smooth, and the error of the load is its slope over the width. Before a jump the branch ends at a
        fold, towards which the load grows like a square root. Neither error exceeds the change over the jump.
        Elsewhere the curve turns smoothly, and the errors are the changes to the nearer of the states beside it. The
        errors are at least twice those to the vertex of a parabola through three places on a smooth branch.
        """
        begins, ends = self.width[place] > 0, self.width[place + 1] > 0
        if begins or ends:
            load = self._error_after_jump(place) if begins else 0.0
            load += self._error_before_jump(place) if ends else 0.0
            approach = float(self.width[place] + self.width[place + 1])
        else:
            load, approach = self._smooth_errors(place)
        for first in (place - 2, place - 1, place):
            rise, distance = self._parabola(place, first)
            load, approach = max(load, PARABOLA_SAFETY * rise), max(approach, PARABOLA_SAFETY * distance)
        return load, approach

    def _smooth_errors(self, place: int) -> tuple[float, float]:
        """Return the least changes of load and of approach to the states beside a place."""
        both = (place - 1, place + 1)
        beside = [other for other in both if self.is_state[other]] or both
        load, approach = (
            min(abs(float(values[place] - values[other])) for other in beside) for values in (self.load, self.approach)
        )
        return load, approach

    def _parabola(self, place: int, first: int) -> tuple[float, float]:
        """Return how far the vertex of a parabola through three places lies from an extreme, in load and approach.

        Zero where it lies beyond the places beside the extreme, or a jump between the three. Around the extreme itself
        the load is the change over half a step at least.
        """
        three = slice(max(first, 0), first + 3)
        x, y = self.approach[three] - self.approach[place], self.load[three] - self.load[place]
        if x.size < 3 or self.width[first + 1 : first + 3].any() or np.diff(x).prod() <= 0:
            return 0.0, 0.0
        slopes = np.diff(y) / np.diff(x)
        curvature = float((slopes[1] - slopes[0]) / (x[2] - x[0]))
        if not curvature > 0:
            return 0.0, 0.0
        vertex = float(x[0] + x[1] - slopes[0] / curvature) / 2
        if first == place - 1:
            return curvature * max(abs(vertex), min(abs(x[::2])) / 2) ** 2, abs(vertex)
        return (curvature * vertex**2, abs(vertex)) if 0 < vertex / x[1] < 1 else (0.0, 0.0)

    def _error_after_jump(self, place: int) -> float:
        """Return the change of load that the slope of the next step makes over the width of the jump."""
        step, change = self._change(place, place + 1)
        error = change * self.width[place] / step if step > 0 else np.inf
        return float(np.fmin(error, self._change(place - 1, place)[1]))

    def _error_before_jump(self, place: int) -> float:
        """Return the change of load to a fold a width away, as a square root of the distance to it."""
        step, change = self._change(place - 1, place)
        error = change / (np.sqrt(1 + step / self.width[place + 1]) - 1) if step > 0 else np.inf
        return float(np.fmin(error, self._change(place, place + 1)[1]))

    def _change(self, first: int, second: int) -> tuple[float, float]:
        """Return the size of the change of approach and of load between two places."""
        return abs(self.approach[second] - self.approach[first]), abs(self.load[second] - self.load[first])


def dimensions_of(data: xr.Dataset) -> int:
    """Return the number of dimensions of the lines or surfaces of a dataset of paths."""
    return next(dimensions for dimensions, names in CURVES.items() if names.load in data)


def curve_inputs(data: xr.Dataset) -> tuple[tuple[xr.DataArray, ...], list[list[str]]]:
    """Return what `LoadCurve.from_states` needs of each path of a study, and the dimension of each along a path.

    Loads of states that did not converge are NaN.
    """
    names = CURVES[dimensions_of(data)]
    states = data.approach, data[names.load].where(is_solved(data.status)), data.jump
    return (*states, *(data[name] for name in names.folds)), [["step"]] * len(states) + [["fold"]] * len(names.folds)


def join_folds(folds: Sequence[Mapping[str, float]], dimensions: int = 1) -> xr.Dataset:
    """Return jumps of a line or a surface along dimension `fold`; one of NaN where there is none."""
    names = CURVES[dimensions].folds
    rows = folds or [dict.fromkeys(names, np.nan)]
    columns = {name: ("fold", np.array([row[name] for row in rows], float)) for name in names}
    return xr.Dataset(columns, {"fold": np.arange(len(rows))})
