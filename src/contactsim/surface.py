"""Height profiles to press with: smooth, self-affine and measured.

A surface is a small frozen description; `heights(points)` samples it on a periodic grid. The largest height touches
first. A finer grid samples the same surface: the random numbers of mode k do not depend on the number of points.

The power spectrum of Eq. 3.10 fixes the mean power of each mode. The text leaves open whether amplitudes are that
value with random phases ("fixed") or Gaussian with that variance ("gaussian", the default, which is what "a Gaussian
height distribution" means); the result is then scaled so that the rms gradient of this very profile is the one asked
for, the gradient being that of the band-limited profile itself, not of its differences on a grid.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from contactsim import measured
from contactsim.errors import SceneError
from contactsim.grid import Array, Grid

AMPLITUDES = ("gaussian", "fixed")


class Surface(Protocol):
    """A periodic height profile; `points` is the number it comes with, None where any number will do."""

    length: float
    points: int | None

    def heights(self, points: int) -> Array:
        """Heights at `points` equispaced positions from 0, shape (points,), nm."""
        ...


def generator(seed: int, *labels: object) -> np.random.Generator:
    """Random numbers for one realisation, the same on every machine: SeedSequence([seed, *labels]).

    Labels that are not whole numbers enter through a digest of their JSON form.
    """
    words = [label if isinstance(label, int) else _word(label) for label in labels]
    return np.random.default_rng(np.random.SeedSequence([seed, *words]))


def _word(label: object) -> int:
    return int.from_bytes(hashlib.sha256(json.dumps(label).encode()).digest()[:8], "big")


def _check_length(length: float) -> None:
    if not (np.isfinite(length) and length > 0):
        raise SceneError("length", length, "a positive, finite period in nm")


@dataclass(frozen=True)
class Flat:
    """A plane at `height` (nm)."""

    length: float
    height: float = 0.0
    points = None

    def __post_init__(self) -> None:
        _check_length(self.length)

    def heights(self, points: int) -> Array:
        """The constant height, shape (points,), nm."""
        return np.full(points, float(self.height))


@dataclass(frozen=True)
class Cylinder:
    """Parabolic cylinder -ρ²/2R (Eq. 3.2, drawn downwards) in the middle of the period; radius, length in nm."""

    length: float
    radius: float
    points = None

    def __post_init__(self) -> None:
        _check_length(self.length)
        if not (np.isfinite(self.radius) and self.radius > 0):
            raise SceneError("radius", self.radius, "a positive, finite number in nm")

    def heights(self, points: int) -> Array:
        """Heights -ρ²/2R, at most 0, shape (points,), nm."""
        offset = Grid((points,), (self.length,)).positions() - self.length / 2
        return -(offset**2) / (2 * self.radius)


@dataclass(frozen=True)
class Sinusoid:
    """amplitude × cos(2π periods x / length): Westergaard's profile; amplitude and length in nm."""

    length: float
    amplitude: float
    periods: int = 1
    points = None

    def __post_init__(self) -> None:
        _check_length(self.length)
        if not (np.isfinite(self.amplitude) and self.amplitude > 0):
            raise SceneError("amplitude", self.amplitude, "a positive, finite number in nm")
        if self.periods < 1:
            raise SceneError("periods", self.periods, "a whole number, 1 or more")

    def heights(self, points: int) -> Array:
        """Heights of the wave, a crest at x = 0, shape (points,), nm."""
        phase = np.arange(points) * self.periods % points / points
        return self.amplitude * np.cos(2 * np.pi * phase)


@dataclass(frozen=True)
class SelfAffine:
    """Random profile with the spectrum of Eq. 3.10: flat to the roll-off, a power law to the shortest wavelength.

    length, rolloff_wavelength, shortest_wavelength: nm; rms_gradient: scaled to this exactly; rng: draws the modes,
    two numbers each, in the order of their wavenumber; amplitudes: "gaussian" or "fixed" (random phases alone).
    """

    length: float
    hurst: float
    rolloff_wavelength: float
    shortest_wavelength: float
    rms_gradient: float
    rng: np.random.Generator
    amplitudes: str = "gaussian"
    points = None

    def __post_init__(self) -> None:
        _check_length(self.length)
        if not 0 <= self.hurst <= 1:
            raise SceneError("hurst", self.hurst, "a number from 0 to 1")
        if not 0 < self.rolloff_wavelength <= self.length:
            raise SceneError("rolloff_wavelength", self.rolloff_wavelength, f"above 0 nm, at most {self.length} nm")
        if not 0 < self.shortest_wavelength < self.rolloff_wavelength:
            allowed = f"above 0 nm, below the roll-off wavelength {self.rolloff_wavelength} nm"
            raise SceneError("shortest_wavelength", self.shortest_wavelength, allowed)
        if not (np.isfinite(self.rms_gradient) and self.rms_gradient > 0):
            raise SceneError("rms_gradient", self.rms_gradient, "a positive, finite number")
        if self.amplitudes not in AMPLITUDES:
            raise SceneError("amplitudes", self.amplitudes, f"one of {list(AMPLITUDES)}")

    @property
    def modes(self) -> int:
        """Number of modes: those with wavelength strictly above the shortest (Eq. 3.10)."""
        return int(np.ceil(self.length / self.shortest_wavelength * (1 - 1e-12))) - 1

    @cached_property
    def coefficients(self) -> Array:
        """Complex Fourier coefficients of modes 0 … `modes` (half-complex, q = 0 the mean), nm."""
        mode = np.arange(1, self.modes + 1)
        q = 2 * np.pi * mode / self.length
        rolloff = 2 * np.pi / self.rolloff_wavelength
        amplitude = np.maximum(q / rolloff, 1.0) ** (-(1 + 2 * self.hurst) / 2)
        normal = self.rng.standard_normal((self.modes, 2)) @ np.array([1, 1j])
        if self.amplitudes == "fixed":
            normal /= np.abs(normal)
        half = amplitude * normal
        gradient = np.sqrt(2 * np.sum(q**2 * np.abs(half) ** 2))
        return np.concatenate(([0.0], half * (self.rms_gradient / gradient)))

    def heights(self, points: int) -> Array:
        """Heights with zero mean, shape (points,), nm."""
        if points <= 2 * self.modes:
            raise SceneError("points", points, f"more than {2 * self.modes}: two points per shortest wavelength")
        half = np.zeros(points // 2 + 1, complex)
        half[: self.modes + 1] = self.coefficients
        return Grid((points,), (self.length,)).backward(half)


@dataclass(frozen=True)
class Sampled:
    """Heights given as numbers: a checked profile (n,) of at least two finite values at equal spacing, nm."""

    profile: measured.Profile

    @property
    def points(self) -> int:
        """Number of heights."""
        return self.profile.heights.size

    @property
    def length(self) -> float:
        """Period: number of points times spacing, nm."""
        return self.points * self.profile.spacing

    def heights(self, points: int) -> Array:
        """The heights as given; `points` must be their number: a measurement is not resampled."""
        if points != self.points:
            raise SceneError("points", points, f"{self.points}, the number of points of the profile")
        return self.profile.heights


@dataclass(frozen=True)
class Measured(Sampled):
    """A profile read from a file, detrended and made periodic (options as in `contactsim.measured`)."""

    profile: measured.Profile = field(init=False, repr=False)
    file: str
    detrend: str = "linear"
    periodic: str = "mirror"
    spacing: float | None = None
    unit: str | None = None
    variable: str | None = None

    def __post_init__(self) -> None:
        raw = measured.read_profile(self.file, spacing=self.spacing, unit=self.unit, variable=self.variable)
        object.__setattr__(self, "profile", measured.prepare(raw, self.detrend, self.periodic))


SURFACES = {"flat": Flat, "cylinder": Cylinder, "sinusoid": Sinusoid, "self_affine": SelfAffine, "measured": Measured}
