"""Hard-wall cases judged: nothing of the solver's own certificate is trusted.

The gap is recomputed in physical units by another route.
"""

from __future__ import annotations

import numpy as np

from contactsim.evaluation.robustness.cases import Case, displacement, mirrored
from contactsim.evaluation.robustness.outcome import Outcome, Verdict
from contactsim.simulation import press
from contactsim.solvers.base import HardWallSolver, Result
from contactsim.status import Status


def judge_wall(case: Case, method: str | HardWallSolver) -> Verdict:
    """Press a case with a solver, and check all that can be checked independently of the solver."""
    result = press(
        case.heights,
        spacing=case.spacing,
        contact_modulus=case.contact_modulus,
        mean_pressure=case.mean_pressure,
        approach=case.approach,
        thickness=case.thickness,
        poisson_ratio=case.poisson_ratio,
        tolerance=case.tolerance,
        solver=method,
    )
    spent = result.record.transforms
    finite = all(np.isfinite(part).all() for part in (result.pressure, result.gap, result.approach))
    if not finite or result.status is Status.NON_FINITE:
        return Verdict(Outcome.NON_FINITE, spent, result.status.sentence)
    if result.status is not Status.CONVERGED:
        return Verdict(Outcome.FAILED, spent, result.status.sentence)
    fault = "answered what it should have refused" if case.refuse else faults(case, result)
    if fault:
        return Verdict(Outcome.WRONG, spent, fault)
    known = case.exact is not None or case.area is not None
    return Verdict(Outcome.RIGHT if known else Outcome.CERTIFIED, spent)


def faults(case: Case, result: Result) -> str:
    """What is wrong with a converged result; empty if nothing is."""
    allowed, pressure = _allowed(case, result), result.pressure
    sunk = case.compliance.flat[0] * result.mean_pressure
    gap = displacement(pressure, case.compliance) - case.heights
    level = gap[result.contact].mean() if sunk else result.approach
    gap -= level
    if abs(level + sunk - result.approach) > allowed + 1e-14 * sunk:
        return "approach and mean displacement do not fit the gap"
    if pressure.min() < 0:
        return "negative pressure"
    if case.approach is not None and abs(result.approach - case.approach) > allowed + 1e-14 * sunk:
        return "not the approach asked for"
    if case.approach is None and abs(result.mean_pressure - case.mean_pressure) > 1e-12 * case.mean_pressure:
        return "forces do not balance"
    if np.abs(gap[result.contact]).max(initial=0.0) > allowed or gap.min() < -allowed:
        return "contact condition violated"
    if case.mean_pressure == 0 and (result.record.iterations or abs(gap.min()) > allowed):
        return "no load, but iterations or no touch"
    precision = _precision(case, result.mean_pressure, allowed)
    if case.exact is not None and _rms(pressure - case.exact) > precision:
        return f"pressure off the exact one by {_rms(pressure - case.exact):.3g} rms, allowed {precision:.3g}"
    if case.area is not None and abs(result.relative_contact_area - case.area) > 1.5 / pressure.size:
        return f"contact area {result.relative_contact_area:.6g}, exact {case.area:.6g}"
    if case.mirror is not None and _rms(pressure - mirrored(pressure, case.mirror)) > 2 * precision:
        return "not mirror symmetric"
    return ""


def _allowed(case: Case, result: Result) -> float:
    """How far a gap may be off: twice the tolerance, and the rounding of heights and of the displacement."""
    highest = np.abs(case.heights).max() or 1.0
    scaled = case.heights / highest
    step = highest * _rms(np.stack([np.roll(scaled, -1, axis) - scaled for axis in range(scaled.ndim)]))
    step = step or (case.mean_pressure or 1.0) * case.spacings[-1] / case.contact_modulus
    reach = result.mean_pressure * (np.array(case.heights.shape) * case.spacings).max() / case.contact_modulus
    return 2 * case.tolerance * step + 1e-14 * (highest + reach)


def _precision(case: Case, load: float, allowed: float) -> float:
    """Largest rms error of the pressure, of any field that meets the contact condition to within `allowed`.

    At equal load, δp·S δp is at most the sum of both loads times the largest error of the gap, and S is at least its
    value for the stiffest wave. Where that says little, because a grid step is large beside what the load moves, a
    hundredth of the exact pressure is the most. With the approach prescribed there is no such bound: a thousandth of
    the load.
    """
    if case.mean_pressure is None:
        return 1e-3 * load
    bound = float(np.sqrt(2 * allowed * load / case.compliance.flat[1:].min())) + 1e-12 * load
    return bound if case.exact is None else min(bound, 1e-2 * _rms(case.exact))


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))
