"""Solve a setup as it is, read quantities off it, and compare two solutions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
import xarray as xr

from contactsim.contact.problem_kind import ProblemKind
from contactsim.error_control.options import LENGTHS
from contactsim.grid import Array
from contactsim.observables.derived import combine_runs, summarise_paths
from contactsim.paths.driver import follow_path
from contactsim.paths.options import Setup
from contactsim.paths.reuse import Reuse
from contactsim.status import is_solved


@dataclass(frozen=True)
class Solution:
    """One solution of a setup.

    Parameters
    ----------
    setup : Setup
        Scene and options that were solved.
    data : xarray.Dataset
        The dataset of the path, with dimension `step`.
    values : dict from str to Array
        Quantities, one value for each load or for the path as a whole.
    increment_errors : dict from str to Array
        What the increments leave of quantities that are extreme between states, by the states beside them.
    """

    setup: Setup
    data: xr.Dataset
    values: dict[str, Array]
    increment_errors: dict[str, Array] = field(default_factory=dict)

    @property
    def points(self) -> int:
        """Grid points along x."""
        return self.setup.points

    @property
    def solved(self) -> bool:
        """True where every state has converged."""
        return bool(is_solved(self.data.status).all())

    @property
    def transforms(self) -> float:
        """Transforms of all steps, in those of its own grid."""
        return float(self.data.transforms.sum())

    @property
    def seconds(self) -> float:
        """CPU seconds of all steps."""
        return float(self.data.seconds.sum())

    def scale(self, name: str) -> Array:
        """Return the size of a quantity, to which its relative error refers.

        A length at a hard wall has at least that of the tolerance, as the gap in full contact, which is rounding.
        """
        sizes = np.abs(self.values[name])
        if name in LENGTHS:
            slope, spacing = self.data.rms_gradient.values, self.data.length.item() / self.points
            sizes = np.maximum(sizes, self.setup.options.tolerance * slope * spacing)
        return sizes

    @property
    def size(self) -> int:
        """All points of the grid."""
        return self.points * int(self.data.get("points_y", 1))


def solve_setup(setup: Setup, names: Sequence[str], coarse: Solution | None = None) -> Solution:
    """Simulate a setup as it is and read quantities off it.

    Parameters
    ----------
    setup : Setup
        Scene and options.
    names : sequence of str
        Quantities to read.
    coarse : Solution, optional
        The same on a coarser grid; at a hard wall the solution begins from its fields.
    """
    loads = setup.scene.kind is ProblemKind.HARD_WALL
    reuse = Reuse(coarse=coarse.data) if loads and coarse is not None and "pressure" in coarse.data else None
    data = follow_path(setup.with_options(accuracy=None), reuse)
    if loads:
        return Solution(setup, data, {name: data[name].values.astype(float) for name in names})
    if not is_solved(data.status).any():
        return Solution(setup, data, {name: np.full(1, np.nan) for name in names})
    summary = summarise_paths(combine_runs([(data.drop_vars("seconds"), {"member": 0})]), names).isel(member=0)
    lacking = xr.DataArray(np.nan)  # such as a slip without a tangential law
    values = {name: np.atleast_1d(summary.get(name, lacking).values.astype(float)) for name in names}
    told = {name: error for name in names if (error := f"{name}_increment_error") in summary}
    return Solution(setup, data, values, {name: np.atleast_1d(summary[error].values) for name, error in told.items()})


def relative_difference(first: Solution, second: Solution, name: str) -> Array:
    """Return the size of the change of a quantity from one solution to another, over the first's value.

    One value for each load, or one for the path. It is zero where both are equal or neither has the quantity, as a
    path without a pull-off; infinite where one alone has it, where only the first is zero, and everywhere if a state of
    either has not converged.
    """
    if not (first.solved and second.solved):
        return np.full(first.values[name].shape, np.inf)
    before, after = first.values[name], second.values[name]
    change, missing = np.full(before.shape, np.inf), np.isnan(before) | np.isnan(after)
    np.divide(np.abs(after - before), np.abs(before), out=change, where=~missing & (before != 0))
    return np.where((np.isnan(before) & np.isnan(after)) | (before == after), 0.0, change)
