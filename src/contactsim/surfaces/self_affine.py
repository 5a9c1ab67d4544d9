"""Rough heights drawn at random: self-affine, along a line or over a surface.

The random numbers of mode k do not depend on the number of points, so a finer grid samples the same heights. The power
spectrum of Eq. 3.10 fixes the mean power of each mode. The text leaves open whether amplitudes are that value with
random phases ("fixed") or Gaussian with that variance ("gaussian", the default, which is what "a Gaussian height
distribution" means); the result is then scaled so that the rms gradient or the rms height of this very profile is the
one asked for, the gradient being that of the band-limited profile itself, not of its differences on a grid.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import Annotated

import numpy as np

from contactsim.arguments import Count, Length, Only, Positive, checked
from contactsim.errors import InputError, is_number
from contactsim.grid import Array, Grid, check_memory
from contactsim.surfaces.base import Dimensions, Smooth

AMPLITUDES = ("gaussian", "fixed")
HurstExponent = Annotated[float, Only("a number from 0 to 1", lambda value: is_number(value) and 0 <= value <= 1)]
Amplitudes = Annotated[str, Only(f"one of {', '.join(AMPLITUDES)}", AMPLITUDES.__contains__)]
MAX_WAVES = 2**28
"""Most waves in a period along each direction."""
CUTOFF_RATIO = 512
"""Long over short cut-off where none is chosen: that of the thesis's rough lines."""


def realisation_seed(seed: int, *labels: object) -> tuple[int, ...]:
    """Return the seed of one realisation, the same on every machine.

    Parameters
    ----------
    seed : int
        Root of all random numbers.
    *labels
        What the realisation is: names and numbers, such as a study, a Hurst exponent and a member. Labels that are not
        whole numbers enter through a digest of their JSON form.
    """
    return (seed, *(label if isinstance(label, int) else _label_word(label) for label in labels))


def _label_word(label: object) -> int:
    """Return a label as a whole number."""
    return int.from_bytes(hashlib.sha256(json.dumps(label).encode()).digest()[:8], "big")


def _is_seed(value: object) -> bool:
    """Return True for a whole number, 0 or more, or a tuple of seeds."""
    if isinstance(value, tuple | list):
        return bool(value) and all(map(_is_seed, value))
    return bool(isinstance(value, int | np.integer) and value >= 0)


Seed = Annotated[
    int | tuple[int, ...], Annotated[object, Only("a whole number, 0 or more, or a tuple of them", _is_seed)]
]


@checked
@dataclass(frozen=True, repr=False)
class SelfAffine(Smooth):
    """Random heights with a self-affine power spectrum (Eq. 3.10): flat at long waves, a power law at short ones.

    The power falls with the wavenumber as q^-(1+2H) along a line and as q^-2(1+H) over an isotropic surface.

    Parameters
    ----------
    length : float
        Period in each direction, in nm.
    hurst_exponent : float
        Hurst exponent H, from 0 to 1.
    long_cutoff : float, optional
        Roll-off wavelength in nm: the spectrum is flat above it. Default: `length`.
    short_cutoff : float, optional
        Wavelength in nm at and below which there are no waves. Default: `long_cutoff` / 512, the thesis's ratio.
    rms_gradient : float, optional
        Rms gradient to which the heights are scaled exactly; over a surface the mean squares of both slopes are added.
    rms_height : float, optional
        Rms height to which they are scaled instead, in nm. Exactly one of the two is needed.
    amplitudes : {"gaussian", "fixed"}
        Gaussian amplitudes, or random phases alone.
    dimensions : int
        1 for a line, 2 for a surface.
    low_pass_cutoff : float, optional
        Wavelength in nm below which waves are left out after the scaling.
    seed : int or tuple of int
        Seed of the random numbers. The numbers of a wave do not depend on the grid nor on the short cut-off.
    """

    length: Length
    hurst_exponent: HurstExponent
    long_cutoff: Length = None  # type: ignore[assignment] # `length` or a number once the surface is made
    short_cutoff: Length = None  # type: ignore[assignment]
    rms_gradient: Positive | None = None
    rms_height: Length | None = None
    amplitudes: Amplitudes = "gaussian"
    dimensions: Dimensions = 1
    low_pass_cutoff: Length | None = None
    seed: Seed = field(default=0, kw_only=True)

    def __post_init__(self) -> None:
        if self.long_cutoff is None:
            object.__setattr__(self, "long_cutoff", self.length)
        if self.long_cutoff > self.length:
            raise InputError("long_cutoff", self.long_cutoff, f"above 0 nm, at most {self.length} nm")
        if self.short_cutoff is None:
            object.__setattr__(self, "short_cutoff", self.long_cutoff / CUTOFF_RATIO)
        shortest = self.length / MAX_WAVES
        if not shortest <= self.short_cutoff < self.long_cutoff:
            allowed = f"at least {shortest:g} nm, below the long cut-off {self.long_cutoff} nm"
            raise InputError("short_cutoff", self.short_cutoff, allowed)
        if (self.rms_gradient is None) == (self.rms_height is None):
            given = None if self.rms_gradient is None else [self.rms_gradient, self.rms_height]
            raise InputError("rms_gradient", given, "exactly one of rms_gradient and rms_height")
        low_pass = self.low_pass_cutoff
        if low_pass is not None and not self.short_cutoff < low_pass < self.long_cutoff:
            ends = f"above the short cut-off {self.short_cutoff} nm, below the long cut-off"
            allowed = f"{ends} {self.long_cutoff} nm, or left out"
            raise InputError("low_pass_cutoff", self.low_pass_cutoff, allowed)

    def __repr__(self) -> str:
        """Return the exact fields that differ from their defaults: equal texts mean equal surfaces."""
        values = ((entry, getattr(self, entry.name)) for entry in fields(self))
        chosen = [f"{entry.name}={value!r}" for entry, value in values if value != entry.default]
        return f"SelfAffine({', '.join(chosen)})"

    @property
    def modes(self) -> int:
        """Highest number of waves in the period along any direction, their wavelength above the cut-off (Eq. 3.10).

        In two dimensions the waves with |k| up to `modes` are kept, all others are zero. That is the disc of the
        highest mode along the axes, so oblique waves between its wavelength and the shortest are left out.
        """
        return _waves(self.length, self.effective_short_cutoff)

    @property
    def effective_short_cutoff(self) -> float:
        """Wavelength above which there are waves, after the low-pass filter, nm."""
        return max(self.short_cutoff, self.low_pass_cutoff or 0.0)

    @cached_property
    def coefficients(self) -> Array:
        """Complex Fourier coefficients of the modes with |k| up to `modes`, half of them along x, nm.

        Shape (modes + 1,) or (2 modes + 1, modes + 1), in the order of a real transform; those of q = 0 are zero.
        """
        if self.low_pass_cutoff is None:
            return self._draw_coefficients(self.modes)
        modes = self.modes
        half = self._draw_coefficients(_waves(self.length, self.short_cutoff))[..., : modes + 1]
        if self.dimensions == 2:
            half = np.concatenate((half[: modes + 1], half[half.shape[0] - modes :]))
        *y, x = self._mode_numbers(modes)
        return half * (self._wavenumber(*y, x) <= 2 * np.pi / self.length * modes * (1 + 1e-12))

    def _draw_coefficients(self, modes: int) -> Array:
        """Return the coefficients of all waves up to `modes`, scaled to the rms gradient or height."""
        *y, x = self._mode_numbers(modes)
        q = self._wavenumber(*y, x)
        drawn = (x > 0) | sum((k > 0 for k in y), np.zeros(x.shape, bool))  # the others are conjugates, or the mean
        drawn &= q <= 2 * np.pi / self.length * modes * (1 + 1e-12)
        order = np.lexsort([*(k[drawn] for k in y), x[drawn], np.max(np.abs([x, *y]), axis=0)[drawn]])
        normal = np.random.default_rng(np.random.SeedSequence(self.seed)).standard_normal((order.size, 2)) @ np.array(
            [1, 1j]
        )
        if self.amplitudes == "fixed":
            normal /= np.abs(normal)
        half = np.zeros(x.shape, complex)
        places = tuple(index[order] for index in np.nonzero(drawn))
        rolloff = 2 * np.pi / self.long_cutoff
        half[places] = (
            np.maximum(q[places] / rolloff, 1.0) ** (-(self.dimensions + 2 * self.hurst_exponent) / 2) * normal
        )
        if y:  # along x = 0 waves of both signs of y are kept
            half[:, 0] += np.conj(np.roll(half[::-1, 0], 1))
        if self.rms_height is not None:
            return half * (self.rms_height / _rms(half))
        assert self.rms_gradient is not None  # exactly one of the two was checked to be there
        return half * (self.rms_gradient / _rms(half, q))

    def _mode_numbers(self, modes: int) -> list[Array]:
        """Return the number of waves in the period of each coefficient, along y first."""
        along = np.arange(modes + 1)
        across = [np.concatenate((along, -along[:0:-1]))] * (self.dimensions - 1)
        return list(np.meshgrid(*across, along, indexing="ij"))

    def _wavenumber(self, *numbers: Array) -> Array:
        """Return the wavenumber |q| (rad/nm) of modes."""
        return 2 * np.pi / self.length * np.sqrt(sum(k**2.0 for k in reversed(numbers)))

    @property
    def profile_rms_gradient(self) -> float:
        """Rms gradient of these heights: the prescribed one, or the one that follows from the rms height or filter."""
        if self.rms_gradient is not None and self.low_pass_cutoff is None:
            return self.rms_gradient
        return _rms(self.coefficients, self._wavenumber(*self._mode_numbers(self.modes)))

    def heights(self, points: Count) -> Array:
        """Return heights of zero mean in nm, shape (points,) or (points, points)."""
        self.check(points)
        check_memory(points, self.shape(points), 2)
        grid = Grid((points,) * self.dimensions, self.lengths)
        half = np.zeros(grid.half_shape, complex)
        half[grid.low_modes(self.modes)] = self.coefficients
        return grid.backward(half)


def _waves(length: float, cutoff: float) -> int:
    """Return the highest number of waves in a period with a wavelength strictly above the cut-off."""
    return int(np.ceil(length / cutoff * (1 - 1e-12))) - 1


def _rms(half: Array, factor: Array | float = 1.0) -> float:
    """Return the rms of a real field, each wave times a factor, from its half-complex coefficients."""
    twice = np.full(half.shape[-1], 2.0)
    twice[0] = 1.0
    return float(np.sqrt(np.sum(twice * factor**2 * np.abs(half) ** 2)))
