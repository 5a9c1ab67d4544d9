"""One load on a surface with the default solver and with a peer, in turns in one process, and where they differ.

Times are CPU seconds on one thread, from the heights to the solution. Ours includes the certificate that ends it; those
of aspher do not, as it has checks of its own. The unit is a real transform of the heights by scipy.
"""

from __future__ import annotations

import os
import resource
import time
from collections.abc import Callable

import numpy as np
import peers
from measure import CAP, LONG, largest_residual, pose_case, run_in_child
from scipy.fft import rfft2

from contactsim.contact.hard_wall import HardWallProblem, Scale
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.grid import Array
from contactsim.solvers.base import solve
from contactsim.solvers.registry import make_solver
from contactsim.study.plan import Plan

OURS = "conjugate_gradients"
CAPPED_SIZE = 2048**2
"""Points up to which a solution may take CAP; on more points it may take longer by their ratio."""

TICKS = 0.3
"""CPU seconds for which the unit is timed in each round."""
Posing = Callable[[], tuple[HardWallProblem, Scale]]


def surface(plan: Plan, case: dict) -> tuple[Posing, Array]:
    """Return a function that poses the case anew, and the heights of its surface (nm)."""
    scene, heights = pose_case(plan, case, [case["reduced_pressure"]], "rough_surface")
    return lambda: pose_hard_wall(scene, scene.path.steps[0], heights, case["tolerance"], 1), heights


def search(plan: Plan, case: dict, rung: int) -> dict:
    """Settings of aspher for a case, sought from a rung of its tolerances on."""
    settings, rung = peers.quickest(surface(plan, case)[0]()[0], rung)
    return {"status": "CONVERGED", "settings": settings, "rung": rung, "load_average": os.getloadavg()[0]}


def tighten(plan: Plan, case: dict, settings: str) -> dict:
    """Settings of aspher for a case: those given, with a tolerance that is tightened until it is certified."""
    found, rung = peers.tightened(surface(plan, case)[0]()[0], peers.Settings.read(settings))
    return {"status": "CONVERGED", "settings": found, "rung": rung, "load_average": os.getloadavg()[0]}


def compare(plan: Plan, case: dict, rounds: int, settings: str) -> dict:
    """Measure our solver and the peer's in turns, in a process with a limit on its CPU time."""
    posing, heights = surface(plan, case)
    solve(make_solver(OURS), *posing())  # compiles
    cap = CAP * max(heights.size // CAPPED_SIZE, 1)
    measured = run_in_child(lambda: measure_in_turns(posing, heights, case["solver"], settings, rounds, cap))
    return measured or {"status": f"not finished in {cap} s", "seconds": cap, "load_average": os.getloadavg()[0]}


def measure_in_turns(posing: Posing, heights: Array, name: str, settings: str, rounds: int, cap: int) -> dict:
    """Measure ours, then the peer's, in each round; return medians of the ratios and the best times."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (int(time.process_time()) + cap, resource.RLIM_INFINITY))
    spent: list[tuple[float, float, float]] = []
    while len(spent) < rounds and (not spent or spent[-1][2] < LONG):
        unit = transform_seconds(heights)
        problem, scale = posing()
        own, own_seconds = time_task(lambda: solve(make_solver(OURS), *posing()))
        (pressure, transforms), seconds = time_task(lambda: solve_with_peer(posing, name, settings))
        spent.append((unit, own_seconds, seconds))
    units, ours, theirs = np.array(spent).T
    certificate, gap = problem.certify(problem.project(pressure))
    own_certificate, own_gap = problem.certify(own.pressure / scale.pressure)
    both = ((own.pressure / scale.pressure, own_gap), (pressure, gap))
    return {
        "status": "CONVERGED" if certificate.met(problem.tolerance) else "MAX_ITERATIONS",
        "settings": settings,
        "area": (pressure > 0).mean(),
        "certificate": largest_residual(certificate),
        "transforms": transforms,
        "seconds": theirs.min(),
        "per_transform": np.median(theirs / units),
        "own_area": own.relative_contact_area,
        "own_certificate": largest_residual(own_certificate),
        "own_transforms": own.record.transforms,
        "own_seconds": ours.min(),
        "own_per_transform": np.median(ours / units),
        "ratio": np.median(theirs / ours),
        "transform_seconds": units.min(),
        "rounds": len(spent),
        "load_average": os.getloadavg()[0],
    } | contact_differences(*both, problem.tolerance)


def time_task(task: Callable) -> tuple:
    """Return the result of a task and the CPU seconds that it takes."""
    begin = time.process_time()
    return task(), time.process_time() - begin


def transform_seconds(heights: Array) -> float:
    """CPU seconds of a real transform by scipy: mean over so many that the clock's ticks, of some ms, do not show."""
    begin, count, spent = time.process_time(), 0, 0.0
    while spent < TICKS:
        rfft2(heights)
        count, spent = count + 1, time.process_time() - begin
    return spent / count


def solve_with_peer(posing: Posing, name: str, settings: str) -> tuple[Array, float]:
    """Return the pressure of a peer, without units, and its transforms."""
    problem, scale = posing()
    if name == "aspher":
        return peers.pressed(problem, peers.Settings.read(settings))
    result = solve(make_solver(name, budget=10**9), problem, scale)
    return result.pressure / scale.pressure, result.record.transforms


def contact_differences(ours: tuple[Array, Array], theirs: tuple[Array, Array], tolerance: float) -> dict:
    """Return how many points only one of the solutions has in contact, and whether these are undecided.

    ours, theirs: pressure in E*·step/spacing and gap in grid steps. Undecided is a point whose pressures and gaps, of
    both, are within the tolerance: about the pressure that moves its own point by as many steps. The largest ones
    among the points that differ are given in tolerances.
    """
    differ = (ours[0] > 0) != (theirs[0] > 0)
    pressure, gap = (
        np.maximum(np.abs(one), np.abs(other))[differ] / tolerance for one, other in zip(ours, theirs, strict=True)
    )
    return {
        "differing": int(differ.sum()),
        "undecided": int(((pressure <= 1) & (gap <= 1)).sum()),
        "largest_pressure": pressure.max(initial=0.0),
        "largest_gap": gap.max(initial=0.0),
    }
