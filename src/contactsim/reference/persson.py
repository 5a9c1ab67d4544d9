"""Persson's theory of the contact of randomly rough surfaces: area, pressures, mean gap and gaps.

Waves of the surface are added one after the other, the longest first. The pressure spreads as they come, and where it
reaches zero the contact is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from contactsim.errors import POSITIVE, InputError, is_positive
from contactsim.grid import Array

ENERGY_PART = 0.45
"""Part γ of the elastic energy of complete contact that a wave stores in the little area in contact, by the fit of Yang
and Persson."""
PARTS = 8
"""Parts in which each wave is added, as if the spectrum of a finite surface were continuous."""
TABLE = np.geomspace(1e-8, 8.0, 10000)
"""Pressures, over those that the waves spread, at which the integral of the mean gap is tabulated."""


@dataclass(frozen=True)
class Spectrum:
    """Waves of a surface from the longest to the shortest.

    Parameters
    ----------
    wavenumbers : array, shape (m,)
        Wavenumbers, rad/nm, the smallest first.
    powers : array, shape (m,)
        Part of the mean square height that each carries, nm².
    """

    wavenumbers: Array
    powers: Array

    @classmethod
    def self_affine(
        cls, length: float, long_cutoff: float, short_cutoff: float, hurst_exponent: float, rms_gradient: float
    ) -> Spectrum:
        """Return the expected spectrum of a self-affine surface (ny, nx); lengths in nm, as of `SelfAffine`."""
        modes = int(np.ceil(length / short_cutoff * (1 - 1e-12))) - 1
        if modes < 1:
            raise InputError("short_cutoff", short_cutoff, f"below the length, {length} nm")
        number = np.arange(-modes, modes + 1)
        size = np.hypot(number[:, None], number)
        size = size[(size > 0) & (size <= modes * (1 + 1e-12))]
        power = np.maximum(size * long_cutoff / length, 1.0) ** (-2 * (1 + hurst_exponent))
        shell = np.rint(size).astype(int)
        powers = np.bincount(shell, power)[1:]
        wavenumbers = 2 * np.pi / length * np.bincount(shell, power * size)[1:] / powers
        gradient = float(np.sqrt(np.sum(wavenumbers**2 * powers)))
        return cls(wavenumbers, powers * (rms_gradient / gradient) ** 2)

    def divided(self, parts: int) -> Spectrum:
        """Return the same spectrum with each wave as several weaker ones of its wavenumber."""
        return Spectrum(np.repeat(self.wavenumbers, parts), np.repeat(self.powers / parts, parts))

    @property
    def rms_height(self) -> float:
        """Rms height, nm."""
        return float(np.sqrt(self.powers.sum()))


def persson_area(reduced_pressure: Array | float) -> Array:
    """Relative contact area erf(√2 p*) of a rough surface (J. Chem. Phys. 115, 3840, doi:10.1063/1.1388626)."""
    from scipy.special import erf  # takes longer to import than most of this package

    return erf(np.sqrt(2) * np.asarray(reduced_pressure))


def persson_pressure_density(
    pressure: Array | float, mean_pressure: float, contact_modulus: float, rms_gradient: float
) -> Array:
    """Return Persson's density of pressure in contact with a rough surface, over the whole area, 1/GPa.

    Parameters
    ----------
    pressure
        Pressures, 0 or more, GPa.
    mean_pressure
        Mean pressure over the whole area, GPa.
    contact_modulus
        E*, GPa.
    rms_gradient
        Rms gradient of the heights.

    Notes
    -----
    A Gaussian about the mean, whose standard deviation E* ḡ/2 is that in full contact, less its mirror image at zero
    pressure. It integrates to `persson_area`, and its first moment to the mean pressure.
    """
    spread = contact_modulus * rms_gradient / 2
    towards, away = ((np.asarray(pressure) - sign * mean_pressure) / spread for sign in (1, -1))
    return (np.exp(-(towards**2) / 2) - np.exp(-(away**2) / 2)) / (spread * np.sqrt(2 * np.pi))


def _check_load(mean_pressure: object) -> None:
    """Raise InputError unless a mean pressure is one number above zero."""
    if not is_positive(mean_pressure):
        raise InputError("mean_pressure", mean_pressure, f"{POSITIVE}, in GPa")


def persson_mean_gap(mean_pressure: float, spectrum: Spectrum, contact_modulus: float) -> float:
    """Return the mean gap (nm) between a rough surface and a flat one, without adhesion.

    Parameters
    ----------
    mean_pressure : float
        Mean pressure over the whole area, GPa, above zero.
    spectrum : Spectrum
        Waves of the surface.
    contact_modulus : float
        E*, GPa.

    Notes
    -----
    It follows from the elastic energy U, of which the load does the work: dU/du = -p. A wave q that the surface carries
    in contact stores E* q/4 of its part of the mean square height, times A (γ + (1-γ) A²), with A the part of the area
    in contact where all waves up to it are seen.

    References
    ----------
    C. Yang and B. N. J. Persson, J. Phys.: Condens. Matter 20, 215214 (2008), doi:10.1088/0953-8984/20/21/215214.
    """
    _check_load(mean_pressure)
    return _mean_gap(mean_pressure, spectrum.divided(PARTS), contact_modulus, 0)


def _mean_gap(pressure: float, spectrum: Spectrum, contact_modulus: float, first: int) -> float:
    """Return the mean gap (nm) that the waves from one on leave where a pressure (GPa) acts."""
    wavenumbers, powers = spectrum.wavenumbers[first:], spectrum.powers[first:]
    parts = powers * wavenumbers**2
    spread = contact_modulus / 2 * np.sqrt(2 * (np.cumsum(parts) - parts / 2))  # in the middle of each part
    integral = np.interp(pressure / spread, TABLE, _gap_integral(), right=0.0)
    return float(contact_modulus / 4 * np.sum(powers * wavenumbers / spread * integral))


@cache
def _gap_integral() -> Array:
    """Return the integral from x on of (γ + 3 (1-γ) erf²) erf'(x)/x at the pressures of `TABLE`."""
    from scipy.special import erf  # takes longer to import than most of this package

    rate = 2 / np.sqrt(np.pi) * np.exp(-(TABLE**2)) * (ENERGY_PART + 3 * (1 - ENERGY_PART) * erf(TABLE) ** 2)
    steps = np.diff(np.log(TABLE)) * (rate[1:] + rate[:-1]) / 2
    return np.concatenate((np.cumsum(steps[::-1])[::-1], [0.0]))


def persson_gap_density(gap: Array | float, mean_pressure: float, spectrum: Spectrum, contact_modulus: float) -> Array:
    """Return Persson's density of the gap out of contact, over the whole area, 1/nm.

    Parameters
    ----------
    gap
        Gaps, 0 or more, nm.
    mean_pressure, spectrum, contact_modulus
        As of `persson_mean_gap`.

    Notes
    -----
    Where a wave takes the surfaces out of contact, the gap is that which the mean gap loses with this part of the
    area. About it the shorter waves, which the surface keeps there, spread the gap as a Gaussian, mirrored at zero. It
    integrates to 1 less `persson_area`. Its own mean is larger than `persson_mean_gap`, as the mirror adds to it: by a
    few per cent at p* = 0.01, by a sixth at 0.1.

    References
    ----------
    A. Almqvist, C. Campañá, N. Prodanov, B. N. J. Persson, J. Mech. Phys. Solids 59, 2355 (2011),
    doi:10.1016/j.jmps.2011.08.004.
    """
    _check_load(mean_pressure)
    places, spectrum = np.asarray(gap, float), spectrum.divided(PARTS)
    variances = np.concatenate(([0.0], np.cumsum(spectrum.powers * spectrum.wavenumbers**2)))
    with np.errstate(divide="ignore"):
        areas = persson_area(mean_pressure / (contact_modulus * np.sqrt(variances)))
    volumes = [
        area * _mean_gap(mean_pressure / area, spectrum, contact_modulus, first)
        for first, area in enumerate(areas[:-1])
    ]
    lost, left = areas[:-1] - areas[1:], np.array([*volumes, 0.0])
    rest = np.cumsum(spectrum.powers[::-1])[::-1]
    density = np.zeros_like(places)
    for share, opened, spread in zip(lost, left[:-1] - left[1:], np.sqrt([*rest[1:], rest[-1]]), strict=True):
        if share > 0:
            towards, away = ((places - sign * opened / share) / spread for sign in (1, -1))
            waves = np.exp(-(towards**2) / 2) + np.exp(-(away**2) / 2)
            density = density + share * waves / (spread * np.sqrt(2 * np.pi))
    return density
