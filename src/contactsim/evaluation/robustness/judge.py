"""Judge what a solver makes of a case, by checks that do not trust the solver.

At a hard wall the gap is recomputed in physical units by another route. Along a path of cohesive laws the equations
are those that `contactsim.evaluation.robustness.path_cases` writes out once more. An exact answer that is met makes a
case exact; else it is certified. Overlap so deep that the laws are extrapolated is a failure.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import takewhile

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.errors import InputError
from contactsim.evaluation.robustness.cases import Case, displacement, mirror_field
from contactsim.evaluation.robustness.outcome import Outcome, Verdict
from contactsim.evaluation.robustness.path_cases import PathCase, max_interpenetration
from contactsim.evaluation.robustness.surface_path_cases import SurfacePathCase
from contactsim.evaluation.robustness.wall_path_cases import WallPathCase
from contactsim.grid import Array
from contactsim.interface.exponentials import MAX_OVERLAP
from contactsim.paths.state import PathState
from contactsim.single_load import press
from contactsim.solvers.base import HardWallSolver, Result, check_solver
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import make_solver
from contactsim.status import Status

ROUNDING = 1e-8
"""Rounding of the traction over its maximum: solving a nearly incompressible layer mode by mode loses that much."""
MAX_FORCE_ERROR = 1e-4
"""Allowed error of a path's forces over the largest, and of gaps over the law's length.

Beside a fold the stiffness nearly vanishes, and a residual within the tolerance moves a state by that much.
"""


def judge(case: Case | PathCase, solver: str | HardWallSolver | CohesiveSolver) -> Verdict:
    """Solve a case and return its verdict, from checks that are independent of the solver.

    Parameters
    ----------
    case : Case or PathCase
        A load at a hard wall, or a path of cohesive laws.
    solver : str or HardWallSolver or CohesiveSolver
        A solver or its name.

    Returns
    -------
    Verdict
        The outcome, the transforms spent, and the reason where the case was not solved.
    """
    try:
        return JUDGES[type(case)](case, solver)
    except InputError as error:
        return Verdict(Outcome.REFUSED, 0.0, str(error))


def _judge_hard_wall(case: Case, solver: str | HardWallSolver) -> Verdict:
    """Press the heights of a case and return the verdict."""
    result = press(
        case.heights,
        spacing=case.spacing,
        contact_modulus=case.contact_modulus,
        mean_pressure=case.mean_pressure,
        approach=case.approach,
        thickness=case.thickness,
        poisson_ratio=case.poisson_ratio,
        tolerance=case.tolerance,
        solver=solver,
    )
    transforms = result.record.transforms
    finite = all(np.isfinite(part).all() for part in (result.pressure, result.gap, result.approach))
    if not finite or result.status is Status.NON_FINITE:
        return Verdict(Outcome.NON_FINITE, transforms, result.status.sentence)
    if result.status is not Status.CONVERGED:
        return Verdict(Outcome.FAILED, transforms, result.status.sentence)
    violation = "answered what it should have refused" if case.refuse else find_violation(case, result)
    if violation:
        return Verdict(Outcome.WRONG, transforms, violation)
    has_answer = case.exact is not None or case.area is not None
    return Verdict(Outcome.EXACT if has_answer else Outcome.CERTIFIED, transforms)


def find_violation(case: Case, result: Result) -> str:
    """Return the first condition that a converged result at a hard wall violates.

    Parameters
    ----------
    case : Case
        The load and, where it is known, its exact answer.
    result : Result
        A solver's converged result.

    Returns
    -------
    str
        The violation in words; empty where there is none.
    """
    allowed, pressure = _max_gap_error(case, result), result.pressure
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
    if case.mean_pressure is not None and abs(result.mean_pressure - case.mean_pressure) > 1e-12 * case.mean_pressure:
        return "forces do not balance"
    if np.abs(gap[result.contact]).max(initial=0.0) > allowed or gap.min() < -allowed:
        return "contact condition violated"
    if case.mean_pressure == 0 and (result.record.iterations or abs(gap.min()) > allowed):
        return "no load, but iterations or no touch"
    precision = _max_pressure_error(case, result.mean_pressure, allowed)
    if case.exact is not None and _rms(pressure - case.exact) > precision:
        return f"pressure off the exact one by {_rms(pressure - case.exact):.3g} rms, allowed {precision:.3g}"
    if case.area is not None and abs(result.relative_contact_area - case.area) > 1.5 / pressure.size:
        return f"contact area {result.relative_contact_area:.6g}, exact {case.area:.6g}"
    if case.mirror is not None and _rms(pressure - mirror_field(pressure, case.mirror)) > 2 * precision:
        return "not mirror symmetric"
    return ""


def _max_gap_error(case: Case, result: Result) -> float:
    """Return the allowed error of the gap: twice the tolerance, and rounding of heights and displacement."""
    highest = np.abs(case.heights).max() or 1.0
    scaled = case.heights / highest
    step = highest * _rms(np.stack([np.roll(scaled, -1, axis) - scaled for axis in range(scaled.ndim)]))
    step = step or (case.mean_pressure or 1.0) * case.spacings[-1] / case.contact_modulus
    reach = result.mean_pressure * (np.array(case.heights.shape) * case.spacings).max() / case.contact_modulus
    return 2 * case.tolerance * step + 1e-14 * (highest + reach)


def _max_pressure_error(case: Case, load: float, allowed: float) -> float:
    """Return the largest rms error of a pressure that meets the contact condition to within `allowed`.

    At equal load, δp·S δp is at most the sum of both loads times the largest error of the gap, and S is at least its
    value for the stiffest mode. That bound says little where a grid step is large beside the displacements: there a
    hundredth of the exact pressure is the bound. At a prescribed approach no such bound exists: a thousandth of the
    load is allowed.
    """
    if case.mean_pressure is None:
        return 1e-3 * load
    bound = float(np.sqrt(2 * allowed * load / case.compliance.flat[1:].min())) + 1e-12 * load
    return bound if case.exact is None else min(bound, 1e-2 * _rms(case.exact))


def _rms(values: Array) -> float:
    """Return the root mean square of values."""
    return float(np.sqrt(np.mean(values**2)))


def _judge_path(case: PathCase, solver: str | CohesiveSolver) -> Verdict:
    """Follow the path of a case and return the verdict; every converged state is checked."""
    solver = make_solver(solver) if isinstance(solver, str) else solver
    check_solver(solver, case.scene)
    problem, states = case.follow(solver)
    transforms = problem.counter.transforms
    converged = list(takewhile(lambda state: state.status is Status.CONVERGED, states))
    violation = find_path_violation(case, problem, converged)
    failed = next((state for state in states if state.status not in (Status.CONVERGED, case.ends)), None)
    if violation:
        return Verdict(Outcome.WRONG, transforms, violation)
    if failed is not None and failed.status is not Status.NO_EQUILIBRIUM:
        outcome = Outcome.NON_FINITE if failed.status is Status.NON_FINITE else Outcome.FAILED
        return Verdict(outcome, transforms, f"at {failed.step.text}: {failed.status.sentence}")
    if [state.status for state in states] != case.statuses:
        ends = ", ".join(state.status.name.lower() for state in states)
        return Verdict(Outcome.WRONG, transforms, f"ended {case.ends.name.lower()} in truth, not {ends}")
    overlap = max_interpenetration(problem, converged)
    if overlap > MAX_OVERLAP:
        reason = f"interpenetration {overlap:.3g}: no law describes so many of its lengths"
        return Verdict(Outcome.FAILED, transforms, reason)
    has_answer = case.exact is not None or case.ends is not Status.CONVERGED or case.twin is not None
    return Verdict(Outcome.EXACT if has_answer else Outcome.CERTIFIED, transforms)


def find_path_violation(case: PathCase, problem: CohesiveProblem, states: Sequence[PathState]) -> str:
    """Return the first condition that the converged states of a path violate.

    Parameters
    ----------
    case : PathCase
        The path and, where they are known, its exact forces.
    problem : CohesiveProblem
        The problem that the states solve.
    states : sequence of PathState
        The converged states from the beginning of the path on. The check ends before the first state of which the
        result itself reports too deep an overlap.

    Returns
    -------
    str
        The violation in words; empty where there is none.
    """
    checked = []
    for state in states:
        if max_interpenetration(problem, [state]) > MAX_OVERLAP:
            break
        checked.append(state)
    for state in checked:
        violation = _find_state_violation(case, state)
        if violation:
            return f"at {state.step.text}: {violation}"
    forces = np.array([case.forces(state.step, state.displacement) for state in checked])
    for name, reference in (("exact", case.exact), ("that of smaller increments", case.branch)):
        error = _relative_force_error(forces, reference)
        if error > MAX_FORCE_ERROR:
            return f"force off {name} by {error:.3g} of the largest"
    return ""


def _find_state_violation(case: PathCase, state: PathState) -> str:
    """Return the first condition that one state violates by itself; empty where there is none."""
    if not np.isfinite(state.displacement).all():
        return "converged, but not finite"
    gap = case.gap(state.step, state.displacement)
    allowed = 2 * case.tolerance * case.strength + ROUNDING * np.abs(case.traction(gap)).max()
    unbalanced = case.residual(state.step, state.displacement)
    if not unbalanced <= allowed:
        return f"unbalanced traction {unbalanced:.3g} GPa, allowed {allowed:.3g}"
    if not case.even:
        return ""
    middle, length = case.points // 2, min(law.interaction_range for law in case.laws)
    skew = gap[0] - mirror_field(gap[0], middle), gap[1] + mirror_field(gap[1], middle)
    return "not mirror symmetric" if np.abs(skew).max() > MAX_FORCE_ERROR * length else ""


def _relative_force_error(forces: Array, reference: Array | None) -> float:
    """Return the largest error of the first forces of a path over the largest reference; 0 without a reference."""
    if reference is None or not forces.size:
        return 0.0
    return float(np.abs(forces - reference[: len(forces)]).max() / np.abs(reference).max())


JUDGES: dict[type, Callable[..., Verdict]] = {
    Case: _judge_hard_wall,
    PathCase: _judge_path,
    SurfacePathCase: _judge_path,
    WallPathCase: _judge_path,
}
"""The judge of each kind of case."""
