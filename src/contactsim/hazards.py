"""Cases that get harder: from severity 0 to 100, and what is right at each.

A hazard is a function of its severity that returns a case: a profile, a load and, where it is known, the right answer.
A solver's outcome on a case is right, certified (the residual is met, no exact answer is known), refused with a reason
or an honest failure. An answer that is wrong or not finite must not occur.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np

from contactsim import analytic
from contactsim.api import press
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.solvers.base import Result, Status
from contactsim.surface import SelfAffine, generator

POINTS = 1024


class Outcome(Enum):
    """What came of a case; the number is stored, the sentence explains it."""

    RIGHT = (0, "right: the exact answer is met")
    CERTIFIED = (1, "certified: the residual is met; no exact answer is known")
    REFUSED = (2, "refused, with a reason")
    FAILED = (3, "honest failure: the status says so")
    WRONG = (4, "wrong")
    NON_FINITE = (5, "a value is not finite")


@dataclass(frozen=True)
class Case:
    """A scene to press: heights (n,) and spacing, contact modulus, mean pressure, tolerance in grid steps.

    answer: whether a result is the exact one, None where that is unknown; refuse: whether it must be refused.
    """

    heights: Array
    mean_pressure: float
    spacing: float = 1.0
    contact_modulus: float = 1.0
    tolerance: float = 1e-4
    answer: Callable[[Result], bool] | None = None
    refuse: bool = False


@dataclass(frozen=True)
class Verdict:
    """Outcome of one solver on one case, the work it took, and the reason of a refusal or failure."""

    outcome: Outcome
    transforms: float
    reason: str = ""


def judge(case: Case, solver: str) -> Verdict:
    """Press a case with a solver, and check all that can be checked independently of the solver."""
    try:
        result = press(
            case.heights,
            spacing=case.spacing,
            contact_modulus=case.contact_modulus,
            mean_pressure=case.mean_pressure,
            tolerance=case.tolerance,
            solver=solver,
        )
    except SceneError as error:
        return Verdict(Outcome.REFUSED, 0.0, str(error))
    spent = result.record.transforms
    if not (np.isfinite(result.pressure).all() and np.isfinite(result.gap).all()):
        return Verdict(Outcome.NON_FINITE, spent)
    if result.status is not Status.CONVERGED:
        return Verdict(Outcome.FAILED, spent, result.status.sentence)
    if case.refuse:
        return Verdict(Outcome.WRONG, spent, "answered what it should have refused")
    fault = faults(case, result)
    if fault:
        return Verdict(Outcome.WRONG, spent, fault)
    if case.answer is None:
        return Verdict(Outcome.CERTIFIED, spent)
    return (
        Verdict(Outcome.RIGHT, spent) if case.answer(result) else Verdict(Outcome.WRONG, spent, "exact answer missed")
    )


def faults(case: Case, result: Result) -> str:
    """What is wrong with a converged result, by a route of its own: numpy's transforms and physical units."""
    heights, size = case.heights, case.heights.size
    step = np.sqrt(np.mean(((np.roll(heights, -1) - heights) / _scale(heights)) ** 2)) * _scale(heights)
    step = step or case.mean_pressure * case.spacing / case.contact_modulus
    q = 2 * np.pi * np.fft.rfftfreq(size, case.spacing)
    response = np.divide(2 / case.contact_modulus, q, out=np.zeros_like(q), where=q > 0)
    gap = np.fft.irfft(np.fft.rfft(result.pressure) * response, size) - heights - result.approach
    # rounding of heights and of their transforms, beside the tolerance
    allowed = 2 * case.tolerance * step + 1e-12 * np.abs(heights).max()
    if result.pressure.min() < 0:
        return "negative pressure"
    if abs(result.mean_pressure - case.mean_pressure) > 1e-9 * case.mean_pressure:
        return "forces do not balance"
    if np.abs(gap[result.contact]).max(initial=0.0) > allowed or gap.min() < -allowed:
        return "contact condition violated"
    return ""


def _scale(heights: Array) -> float:
    return float(np.abs(heights).max()) or 1.0


def _rough(points: int = POINTS, hurst: float = 0.8) -> Array:
    surface = SelfAffine(points, hurst, points / 4, 8.0, 1.0, generator(5, hurst))
    return surface.heights(points)


def _wave(points: int) -> Array:
    return np.cos(2 * np.pi * np.arange(points) / points)


def _wave_case(points: int, ratio: float) -> Case:
    """A wave at p/p_c; the tolerance resolves the gap, which shrinks with the cube of the open part."""
    load = ratio * analytic.full_contact_pressure(1.0, points, 1.0)
    area = analytic.sinusoid_area(ratio)

    def answer(result: Result) -> bool:
        return abs(result.relative_contact_area - area) <= 1.5 / points

    return Case(_wave(points), load, tolerance=1e-6, answer=answer)


def few_points(severity: float) -> Case:
    """The load on a rough line falls to p* = 1e-7, until one point carries all of it."""
    heights, load = _rough(), 10 ** (-2 - severity / 20)

    def answer(result: Result) -> bool:
        return result.contact[np.argmax(heights)] and result.relative_contact_area < 0.2

    return Case(heights, load, answer=answer)


def light_wave(severity: float) -> Case:
    """A wave touches ever more lightly, down to p/p_c = 1e-8; area known (Westergaard)."""
    return _wave_case(POINTS, 0.5 * 10 ** (-8 * severity / 100))


def nearly_full_wave(severity: float) -> Case:
    """A wave opens ever less, up to 1 - p/p_c = 1e-5; area known (Westergaard)."""
    return _wave_case(POINTS, 1 - 0.5 * 10 ** (-severity / 100 * 4.7))


def nearly_full_rough(severity: float) -> Case:
    """A rough line just short of complete contact, down to one part in a million."""
    heights = _rough()
    least = -analytic.complete_contact(heights, POINTS, 1.0).min()
    return Case(heights, least * (1 - 10 ** (-1 - severity / 20)))


def full_contact(severity: float) -> Case:
    """A rough line at or beyond complete contact, by a factor from 1e6 down to one part in a million: exact."""
    heights = _rough()
    flat = analytic.complete_contact(heights, POINTS, 1.0)
    load = -flat.min() * (1 + 10 ** (6 - 12 * severity / 100))

    def answer(result: Result) -> bool:
        return bool(np.allclose(result.pressure, load + flat, rtol=0, atol=1e-3 * np.std(flat)))

    return Case(heights, load, answer=answer)


def spike(severity: float) -> Case:
    """A single point sticks out of a plane, ten to ten million spacings high: it carries the load."""
    height, points = 10 ** (1 + 6 * severity / 100), 257
    heights = np.zeros(points)
    heights[100] = height

    def answer(result: Result) -> bool:
        alone = np.flatnonzero(result.contact).tolist() == [100]
        return alone and np.isclose(result.pressure[100], 1e-3 * points, rtol=1e-6)

    return Case(heights, 1e-3, answer=answer)


def flat(severity: float) -> Case:
    """Ripples on a plane vanish, from a tenth of what the load flattens down to none: complete contact, exact."""
    ripple = 0.0 if severity >= 100 else 0.1 * 10 ** (-severity / 5)
    heights = 7.0 + ripple * np.random.default_rng(0).uniform(-1, 1, 256)
    flattened = analytic.complete_contact(heights - 7.0, 256.0, 1.0)

    def answer(result: Result) -> bool:
        return bool(np.allclose(result.pressure, 1.0 + flattened, rtol=0, atol=1e-3 * np.ptp(flattened) + 1e-12))

    return Case(heights, 1.0, answer=answer)


def white_noise(severity: float) -> Case:
    """Noise up to the Nyquist wavenumber takes over a rough line, and at last alternates point by point."""
    if severity >= 100:
        zigzag = (-1.0) ** np.arange(POINTS)

        def answer(result: Result) -> bool:
            return bool(np.allclose(result.pressure, np.where(zigzag > 0, 0.2, 0.0), rtol=0, atol=1e-4))

        return Case(zigzag, 0.1, answer=answer)
    share = severity / 100
    return Case((1 - share) * _rough() + share * np.random.default_rng(1).normal(size=POINTS), 0.1)


def steep_slopes(severity: float) -> Case:
    """Slopes from 1e-3 to 1e3: the contact set is that of slope 1 (small slopes are assumed in the model)."""
    slope, heights = 10 ** (-3 + 6 * severity / 100), _rough()
    reference = press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=0.02, tolerance=1e-4)

    def answer(result: Result) -> bool:
        return np.array_equal(result.contact, reference.contact)

    return Case(slope * heights, slope * 0.02, answer=answer)


def awkward_sizes(severity: float) -> Case:
    """A wave on 2, 3, 5 … points, then on ever larger odd and prime numbers of them; area known."""
    sizes = (2, 3, 5, 7, 13, 31, 67, 127, 255, 509, 1021, 4093, 8191)
    return _wave_case(sizes[round(severity / 100 * (len(sizes) - 1))], 0.3)


def units(severity: float) -> Case:
    """Lengths in units from 1e-12 to 1e12 and moduli the other way round: the same contact set."""
    unit = 10 ** (-12 + 24 * severity / 100)
    heights = _rough()
    reference = press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=0.02, tolerance=1e-4)

    def answer(result: Result) -> bool:
        return np.array_equal(result.contact, reference.contact)

    return Case(unit * heights, 0.02 / unit, spacing=unit, contact_modulus=1 / unit, answer=answer)


def far_datum(severity: float) -> Case:
    """The profile's zero moves away from it, to a million times its height: rounding, and nothing else, changes."""
    return Case(_rough() + 10 ** (8 * severity / 100), 0.02)


def zero_load(severity: float) -> Case:
    """No load, on profiles from 1e-12 to 1e12 high: no contact, and no iteration."""
    heights = _rough() * 10 ** (-12 + 24 * severity / 100)

    def answer(result: Result) -> bool:
        return not result.contact.any() and result.record.iterations == 0

    return Case(heights, 0.0, answer=answer)


def tension(severity: float) -> Case:
    """A negative load, from -1e-12 to -1: nothing can pull, so it is refused."""
    return Case(_rough(), -(10 ** (-12 + 12 * severity / 100)), refuse=True)


def tight_tolerance(severity: float) -> Case:
    """The tolerance falls from 1e-2 to 1e-18 grid steps, below what rounding allows."""
    return Case(_rough(256), 0.02, tolerance=10 ** (-2 - 16 * severity / 100))


HAZARDS: dict[str, Callable[[float], Case]] = {
    hazard.__name__: hazard
    for hazard in (
        few_points,
        light_wave,
        nearly_full_wave,
        nearly_full_rough,
        full_contact,
        spike,
        flat,
        white_noise,
        steep_slopes,
        awkward_sizes,
        units,
        far_datum,
        zero_load,
        tension,
        tight_tolerance,
    )
}
