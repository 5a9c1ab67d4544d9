"""Surfaces by the name of their kind; those given as numbers, and read from files, among them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from contactsim.errors import InputError
from contactsim.grid import Array
from contactsim.surfaces.preparation import prepare
from contactsim.surfaces.profile import Profile, read_profile
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid, Sphere
from contactsim.surfaces.topography import Topography, read_topography


@dataclass(frozen=True)
class Sampled:
    """Heights given as numbers: a checked profile (n,) or topography (ny, nx), at equal spacing, nm."""

    profile: Profile | Topography
    modes = None

    @property
    def points(self) -> int:
        """Number of heights along x."""
        return self.profile.heights.shape[-1]

    @property
    def lengths(self) -> tuple[float, ...]:
        """Period: number of points times spacing, nm."""
        return tuple(np.atleast_1d(self.profile.spacing) * self.profile.heights.shape)

    def shape(self, points: int) -> tuple[int, ...]:
        """Shape of the heights, whatever `points` says."""
        return self.profile.heights.shape

    def check(self, points: int) -> None:
        """Refuse another number of points than there are: a measurement is not resampled."""
        if points != self.points:
            raise InputError("points", points, f"{self.points}, the number of points of the measurement")

    def heights(self, points: int) -> Array:
        """The heights as given; `points` must be their number along x."""
        self.check(points)
        return self.profile.heights


@dataclass(frozen=True)
class Measured(Sampled):
    """A profile read from a file, detrended and made periodic (options as in `contactsim.surfaces.preparation`)."""

    profile: Profile = field(init=False, repr=False)
    file: str
    detrend: str = "linear"
    periodic: str = "mirror"
    spacing: float | None = None
    unit: str | None = None
    variable: str | None = None

    def __post_init__(self) -> None:
        raw = read_profile(self.file, spacing=self.spacing, unit=self.unit, variable=self.variable)
        object.__setattr__(self, "profile", prepare(raw, self.detrend, self.periodic))


@dataclass(frozen=True)
class MeasuredSurface(Sampled):
    """A topography read from a file, detrended and made periodic (options as in `contactsim.surfaces.preparation`)."""

    profile: Topography = field(init=False, repr=False)
    file: str
    detrend: str = "plane"
    periodic: str = "mirror"
    spacing: float | list[float] | None = None
    unit: str | None = None
    variable: str | None = None
    dimensions = 2

    def __post_init__(self) -> None:
        raw = read_topography(self.file, spacing=self.spacing, unit=self.unit, variable=self.variable)
        object.__setattr__(self, "profile", prepare(raw, self.detrend, self.periodic))


SURFACES = {
    "flat": Flat,
    "cylinder": Cylinder,
    "sphere": Sphere,
    "sinusoid": Sinusoid,
    "self_affine": SelfAffine,
    "measured": Measured,
    "measured_surface": MeasuredSurface,
}
