"""Paths of smooth laws judged, by the equations as `hazards.paths` writes them out once more.

An exact load, an exact end, or the load of a twin makes a path right; else it is certified, and where a case asks for
it on the branch of smaller increments. Overlap so deep that the laws are continued there, which the result itself
reports as interpenetration, is a failure.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import takewhile

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.evaluation.robustness.cases import mirrored
from contactsim.evaluation.robustness.outcome import Outcome, Verdict
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.grid import Array
from contactsim.interface.cohesive_zone import MAX_OVERLAP
from contactsim.observables.adhesion import state_observables
from contactsim.paths.state import PathState
from contactsim.solvers.base import check_solver
from contactsim.solvers.cohesive.base import CohesiveSolver
from contactsim.solvers.registry import make_solver
from contactsim.status import Status

ROUNDING = 1e-8
"""Of the largest traction: what solving a nearly incompressible layer, wave by wave, loses."""
AGREED = 1e-4
"""Of the largest load of a path, and of the laws' length: what a residual within the tolerance can make beside a fold,
where the stiffness all but vanishes."""


def judge_path(case: PathCase, method: str | CohesiveSolver) -> Verdict:
    """Follow a case's path with a solver, and check every state that it calls converged."""
    method = make_solver(method) if isinstance(method, str) else method
    check_solver(method, case.scene)
    problem, states = case.follow(method)
    spent = problem.counter.transforms
    fit = list(takewhile(lambda state: state.status is Status.CONVERGED, states))
    fault = path_faults(case, problem, fit)
    failed = next((state for state in states if state.status not in (Status.CONVERGED, case.ends)), None)
    if fault:
        return Verdict(Outcome.WRONG, spent, fault)
    if failed is not None and failed.status is not Status.NO_EQUILIBRIUM:
        outcome = Outcome.NON_FINITE if failed.status is Status.NON_FINITE else Outcome.FAILED
        return Verdict(outcome, spent, f"at {failed.step.text}: {failed.status.sentence}")
    if [state.status for state in states] != case.statuses:
        ends = ", ".join(state.status.name.lower() for state in states)
        return Verdict(Outcome.WRONG, spent, f"ended {case.ends.name.lower()} in truth, not {ends}")
    if max_interpenetration(problem, fit) > MAX_OVERLAP:
        reason = f"interpenetration {max_interpenetration(problem, fit):.3g}: no law describes so many of its lengths"
        return Verdict(Outcome.FAILED, spent, reason)
    known = case.exact is not None or case.ends is not Status.CONVERGED or case.twin is not None
    return Verdict(Outcome.RIGHT if known else Outcome.CERTIFIED, spent)


def path_faults(case: PathCase, problem: CohesiveProblem, states: Sequence[PathState]) -> str:
    """What is wrong with the converged states at the beginning of a path; empty if nothing is.

    Nothing is said of those that the result itself reports as overclosed, nor of what follows.
    """
    sound = []
    for state in states:
        if max_interpenetration(problem, [state]) > MAX_OVERLAP:
            break
        sound.append(state)
    for state in sound:
        fault = _state_fault(case, state)
        if fault:
            return f"at {state.step.text}: {fault}"
    loads = np.array([case.forces(state.step, state.displacement) for state in sound])
    for name, wanted in (("exact", case.exact), ("that of smaller increments", case.branch)):
        off = _off(loads, wanted)
        if off > AGREED:
            return f"force off {name} by {off:.3g} of the largest"
    return ""


def _state_fault(case: PathCase, state: PathState) -> str:
    """What is wrong with one state by itself."""
    if not np.isfinite(state.displacement).all():
        return "converged, but not finite"
    gap = case.gap(state.step, state.displacement)
    allowed = 2 * case.tolerance * case.strength + ROUNDING * np.abs(case.traction(gap)).max()
    unbalanced = case.residual(state.step, state.displacement)
    if not unbalanced <= allowed:
        return f"unbalanced traction {unbalanced:.3g} GPa, allowed {allowed:.3g}"
    if not case.even:
        return ""
    about, length = case.points // 2, min(law.interaction_range for law in case.scene.effects)
    skew = gap[0] - mirrored(gap[0], about), gap[1] + mirrored(gap[1], about)
    return "not mirror symmetric" if np.abs(skew).max() > AGREED * length else ""


def _off(loads: Array, wanted: Array | None) -> float:
    """Largest difference of the first loads of a path, over the largest of what is wanted; 0 where nothing is."""
    if wanted is None or not loads.size:
        return 0.0
    return float(np.abs(loads - wanted[: len(loads)]).max() / np.abs(wanted).max())


def max_interpenetration(problem: CohesiveProblem, states: Sequence[PathState]) -> float:
    """Deepest overlap, in the laws' lengths, as the results report it."""
    deepest = 0.0
    for state in states:
        here = problem.at(state.step)
        gap = here.gap(state.displacement)
        deepest = max(deepest, state_observables(here, gap, here.traction(gap))["max_interpenetration"])
    return deepest
