"""Measured heights along a line or over an area, which are pressed like synthetic ones.

The largest height touches first (for the other side, negate them). A measurement does not repeat: it is pressed alone
on a half-space, or `contactsim.prepare_topography` makes it periodic.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Annotated

import numpy as np

from contactsim.arguments import Count, Only, checked
from contactsim.errors import POSITIVE, InputError
from contactsim.grid import Array
from contactsim.topography_files import io

MAX_SLOPE = 10.0
"""Largest median slope of measured heights."""
SAMPLED_LINES = 256
"""Lines in each direction from which the median is taken, or up to twice as many."""


@checked
@dataclasses.dataclass(frozen=True, eq=False)
class Topography:
    """Measured heights along a line or over an area: a surface with its own number of points.

    Parameters
    ----------
    values : array, shape (n,) or (ny, nx)
        Heights in nm, up positive; element (0, 0) has the smallest x and y.
    spacing : float or (float, ...)
        Distance between points in nm, one for all directions or one for each, x last; kept as a tuple.
    source : str, optional
        Where the heights come from; errors name it.
    filled, spikes : float
        Share of the points that were missing and have been filled, and of those that were spikes and replaced.
    periodic : bool
        Whether the heights repeat; a measurement does not, unless it is made to.

    Raises
    ------
    InputError
        If there are not two or more finite heights in each of one or two directions, or a spacing is not positive.
    """

    values: Array = dataclasses.field(repr=False)
    spacing: Annotated[tuple[float, ...], float | Sequence[float]]
    source: str | None = None
    filled: float = 0.0
    spikes: float = 0.0
    periodic: bool = False
    modes = None

    def __post_init__(self) -> None:
        """Check both and keep them as float64 and floats."""
        values = io.finite_numbers(self.values, "heights", self.source, dims=dimensions_of(self.values))
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "spacing", read_spacing(self.spacing, values.ndim, self.source))

    def __repr__(self) -> str:
        """Return number of points, size, range of heights, and what was done to them, in one line."""
        points = " × ".join(map(str, self.values.shape))
        size = " × ".join(f"{length:.6g}" for length in self.lengths)
        text = f"{points} points on {size} nm, heights from {self.values.min():.6g} to {self.values.max():.6g} nm"
        shares = {"filled": self.filled, "replaced as spikes": self.spikes}
        text += "".join(f", {share:.2%} {words}" for words, share in shares.items() if share)
        text += ", periodic" if self.periodic else ""
        return f"<Topography: {text}{f', of {self.source}' if self.source else ''}>"

    @property
    def points(self) -> int:
        """Number of heights along x."""
        return int(self.values.shape[-1])

    @property
    def lengths(self) -> tuple[float, ...]:
        """Length in each direction, x last: number of points times spacing, nm."""
        return tuple(size * step for size, step in zip(self.values.shape, self.spacing, strict=True))

    def shape(self, points: Count) -> tuple[int, ...]:
        """Return the shape of the heights, which does not depend on `points`."""
        return self.values.shape

    def check(self, points: Count) -> None:
        """Raise an InputError for another number of points along x: a measurement is not resampled."""
        if points != self.points:
            raise InputError("points", points, f"{self.points}, the number of points of the measurement")

    def heights(self, points: Count) -> Array:
        """Return the heights in nm; `points` must be their number along x."""
        self.check(points)
        return self.values

    def thinned(self, stride: Count) -> Topography:
        """Return every so many points, 1, 2 or 4, in each direction, of the part whose numbers of points 4 divides."""
        values = self.values[tuple(slice(0, size - size % 4, stride) for size in self.values.shape)]
        if values.shape == self.values.shape:
            return self
        return dataclasses.replace(self, values=values, spacing=tuple(stride * step for step in self.spacing))


def is_gentle(topography: Topography) -> bool:
    """Return True unless most neighbouring points, of a sample, differ by so much that units must be mixed up.

    The walls of a punch or a post, however steep, are few.
    """
    for axis, step in enumerate(topography.spacing):
        lines = np.moveaxis(topography.values, axis, -1).reshape(-1, topography.values.shape[axis])
        differences = np.abs(np.diff(lines[:: max(len(lines) // SAMPLED_LINES, 1)]))
        if np.median(differences) > MAX_SLOPE * step:
            return False
    return True


MEASURED = (
    f"a Topography, from read_topography(path), of slopes up to {MAX_SLOPE:g}: beyond, heights and spacing probably "
    "have different units"
)
Measured = Annotated[Topography, Only(MEASURED, is_gentle)]


def dimensions_of(values: object) -> int:
    """Return the dimensions to expect of heights: 1 for a list of numbers, 2 otherwise."""
    return 1 if np.ndim(np.ma.asarray(values)) == 1 else 2


def read_spacing(spacing: object, dimensions: int, file: object) -> tuple[float, ...]:
    """Return the spacing in each direction from one number, or one for each direction."""
    values = list(spacing) if isinstance(spacing, list | tuple | np.ndarray) and np.ndim(spacing) == 1 else None
    values = [spacing] * dimensions if values is None else values
    if len(values) != dimensions:
        allowed = f"{POSITIVE}, in nm" + ", or a pair (dy, dx) of them" * (dimensions == 2)
        raise InputError("spacing", spacing, allowed, file)
    return tuple(io.positive_spacing(value, file) for value in values)
