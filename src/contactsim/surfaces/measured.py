"""Surfaces that a config reads from files of measured heights."""

from __future__ import annotations

from dataclasses import dataclass, field

from contactsim.grid import Array
from contactsim.surfaces.preparation import prepare_topography
from contactsim.surfaces.scan_files import read_topography
from contactsim.surfaces.topography import Topography


@dataclass(frozen=True)
class MeasuredLine:
    """Heights along a line, read from a file and prepared.

    Parameters
    ----------
    file, spacing, unit, variable, fill
        As `path` and the options of `contactsim.read_topography`.
    detrend, ends, spikes
        As in `contactsim.prepare_topography`; by default a mirror image makes the heights periodic.
    """

    file: str
    detrend: str = "linear"
    ends: str = "mirror"
    spacing: float | None = None
    unit: str | None = None
    variable: str | None = None
    fill: str | None = None
    spikes: float | None = None
    topography: Topography = field(init=False, repr=False)
    modes = None
    level = "none"
    dimensions = 1

    def __post_init__(self) -> None:
        raw = read_topography(
            self.file,
            dimensions=self.dimensions,
            spacing=self.spacing,
            unit=self.unit,
            variable=self.variable,
            fill=self.fill,
        )
        object.__setattr__(
            self, "topography", prepare_topography(raw, self.detrend, self.ends, self.level, self.spikes)
        )

    @property
    def points(self) -> int:
        """Number of heights along x."""
        return self.topography.points

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period in each direction, x last, nm."""
        return self.topography.lengths

    def shape(self, points: int) -> tuple[int, ...]:
        """Return the shape of the heights."""
        return self.topography.shape(points)

    def check(self, points: int) -> None:
        """Raise an InputError for another number of points along x than that of the heights."""
        self.topography.check(points)

    def heights(self, points: int) -> Array:
        """Return the heights in nm; `points` must be their number along x."""
        return self.topography.heights(points)


@dataclass(frozen=True)
class MeasuredSurface(MeasuredLine):
    """Heights over an area, read from a file and prepared; parameters as those of `MeasuredLine`, and `level`."""

    detrend: str = "plane"
    level: str = "none"
    spacing: float | list[float] | None = None  # type: ignore[assignment]  # an area may have two
    dimensions = 2
