"""Profiles and one-line ways to press them, shared by the tests of solvers; and how an input is refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import mpmath
import numpy as np
import pytest

import contactsim
from contactsim.errors import InputError
from contactsim.solvers.base import Result
from contactsim.solvers.registry import REQUIRED_PACKAGES, SOLVERS, solver_class
from contactsim.status import Status
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.traits import Trait

ALL = tuple(
    kind for kind in SOLVERS if kind not in REQUIRED_PACKAGES and {Trait.LINE, Trait.WALL} <= solver_class(kind).accepts
)
ON_SURFACES = tuple(
    kind
    for kind in SOLVERS
    if kind not in REQUIRED_PACKAGES and {Trait.SURFACE, Trait.WALL} <= solver_class(kind).accepts
)
FAST = ("active_set", "polonsky_keer")


@contextmanager
def refused(key: str, allowed: str) -> Iterator[pytest.ExceptionInfo[InputError]]:
    """Expect a InputError whose key ends so, and whose allowed values say so."""
    with pytest.raises(InputError) as caught:
        yield caught
    assert caught.value.key.endswith(key)
    assert allowed in caught.value.allowed


def rough(points: int, hurst_exponent: float = 0.8, gradient: float = 1.0, modes: int = 0) -> np.ndarray:
    """A self-affine profile on `points` points of unit spacing, with a shortest wavelength of 8 points."""
    modes = modes or points // 8
    surface = SelfAffine(
        points, hurst_exponent, points / 4, points / (modes + 0.5), gradient, seed=realisation_seed(7, hurst_exponent)
    )
    return surface.heights(points)


def wave(points: int) -> np.ndarray:
    """One crest of amplitude 1 at x = 0."""
    return np.cos(2 * np.pi * np.arange(points) / points)


def press(heights: np.ndarray, pressure: float, solver: str = "active_set", **options: float) -> Result:
    """Press a profile of unit spacing into a half-space of unit modulus."""
    return contactsim.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=pressure, solver=solver, **options)


def orders(errors: Sequence) -> np.ndarray:
    """Return the observed orders between errors on grids, or with increments, that halve each time."""
    return np.log2(np.divide(errors[:-1], errors[1:]))


def assert_certified(result: Result, tolerance: float = 1e-3) -> None:
    """Assert that a result is converged and finite, pushes only, carries its load, and meets the tolerance."""
    assert result.status is Status.CONVERGED
    assert np.isfinite(result.pressure).all()
    assert np.isfinite(result.gap).all()
    assert result.record.certificate.met(tolerance)


def compliance(points: int) -> np.ndarray:
    """The dense compliance matrix of unit spacing and unit modulus, by an independent sum over waves."""
    q = 2 * np.pi * np.abs(np.fft.fftfreq(points))
    symbol = np.divide(2.0, q, out=np.zeros(points), where=q > 0)
    first = np.fft.ifft(symbol).real
    index = np.arange(points)
    return first[(index[:, None] - index) % points]


def refusal(key: str, file: object, call: Callable[[], object]) -> InputError:
    """Return the error of a call, after checking that it names file, key, value and what is allowed."""
    with pytest.raises(InputError) as caught:
        call()
    error = caught.value
    assert error.key == key
    assert str(error.file) == str(file)
    assert error.allowed
    assert str(error).startswith(f"{file}: {key}: got ")
    assert str(error).endswith(f"allowed: {error.allowed}")
    return error


def navier(ratio: float) -> mpmath.matrix:
    """Navier's equations in plane strain for q = 1, μ = 1: what u_x, u_z, σ_xz, σ_zz change by along z."""
    nu, one = mpmath.mpf(ratio), mpmath.mpc(0, 1)
    side = nu / (1 - nu)
    return mpmath.matrix(
        [
            [0, -one, 1, 0],
            [-side * one, 0, 0, (1 - 2 * nu) / (2 * (1 - nu))],
            [2 / (1 - nu), 0, 0, -one * side],
            [0, 0, -one, 0],
        ]
    )
