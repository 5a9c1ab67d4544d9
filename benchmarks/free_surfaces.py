"""What a rough surface costs that is pressed alone on a half-space: the default solver in turns with other codes.

    python benchmarks/free_surfaces.py          # --quick: a coarse grid, and nothing here changes

Each surface is a quarter of a periodic self-affine one, so that its ends do not meet. Other codes get the tolerance, of
two a decade, at which our certificate accepts what they return. Install them first (README.md beside this file); one
that is not installed is left out.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec

import numpy as np
from peers import RUNGS, pressed_by_contact_mechanics
from tabulated import Benchmark

import contactsim as cs
from contactsim.contact.hard_wall import HardWallProblem
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.elasticity.half_space import FreeHalfSpace
from contactsim.grid import Array
from contactsim.solvers.base import solve
from contactsim.solvers.registry import default_solver

TOLERANCE = 1e-6
"""Largest gap in contact, and overlap elsewhere, in grid steps."""
ROUNDS = 3


def pressed_by_tamaas(problem: HardWallProblem, tolerance: float) -> Array:
    """Pressure (ny, nx) by conjugate gradients of Polonsky and Keer, on a doubled grid."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    heights = problem.heights
    shape = list(heights.shape)
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [float(size) for size in shape], shape)
    model.E, model.nu = 1.0, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tamaas.PolonskyKeerRey(model, np.ascontiguousarray(heights), tolerance)
    solver.setIntegralOperator("dcfft")
    solver.max_iter, solver.dump_freq = 20000, 10**9
    solver.solve(load_of(problem) / heights.size)
    return np.array(model.traction).reshape(shape)


def pressed_by_aspher(problem: HardWallProblem, tolerance: float, backend: str) -> Array:
    """Pressure (ny, nx) by nested conjugate gradients of Polonsky and Keer."""
    import aspher

    heights = problem.heights
    points = len(heights)
    found = aspher.solve_nested(
        grid_size=points,
        gap=-heights,
        p_nominal=load_of(problem) / heights.size,
        domain_size=float(points),
        E_star=1.0,
        backend=backend,
        tol=tolerance,
        coarse_tol=1e-3,
        light_result=True,
    )
    return np.array(found.pressure)


PEERS: dict[str, tuple[str, Callable[[HardWallProblem, float], Array]]] = {
    "tamaas": ("tamaas", pressed_by_tamaas),
    "ContactMechanics": ("ContactMechanics", partial(pressed_by_contact_mechanics, is_free=True)),
    "aspher fft": ("aspher", partial(pressed_by_aspher, backend="fft")),
    "aspher h2": ("aspher", partial(pressed_by_aspher, backend="h2")),
}
"""Name of a code, its package, and how it presses."""


def load_of(problem: HardWallProblem) -> float:
    """Load, without units."""
    return problem.prescribed_load * problem.size


def surface(points: int, hurst_exponent: float) -> Array:
    """Heights (points, points) of unit spacing and unit rms gradient before the cut."""
    length = 2.0 * points
    whole = cs.SelfAffine(length, hurst_exponent, length / 4, 8.0, 1.0, dimensions=2, seed=7).heights(2 * points)
    return np.ascontiguousarray(whole[:points, :points])


def scene(heights: Array, reduced_pressure: float) -> cs.Scene:
    """The surface on a half-space of unit modulus."""
    return cs.Scene(FreeHalfSpace(1.0), cs.Topography(heights, 1.0), cs.HardWall(), cs.pressures([reduced_pressure]))


def seconds_of(problem: HardWallProblem, press: Callable[[HardWallProblem, float], Array], tolerance: float) -> tuple:
    """CPU seconds of a code, its pressure on the whole cell, and the error that our certificate finds."""
    begin = time.process_time()
    found = press(problem, tolerance)
    spent = time.process_time() - begin
    pressure = problem.project(found)
    certificate = problem.certify(pressure)[0]
    return spent, pressure, max(certificate.max_contact_gap, certificate.penetration)


def compare(case: dict, quick: bool) -> dict:
    """Seconds of a code and of ours, in turns, at the loosest tolerance that is certified."""
    subject = scene(surface(case["points"], case["hurst_exponent"]), case["reduced_pressure"])
    heights, step = subject.heights(case["points"]), subject.path.steps[0]
    problem = pose_hard_wall(subject, step, heights, TOLERANCE, 1)[0]
    press = PEERS[case["peer"]][1]
    for asked in RUNGS:
        _, pressure, error = seconds_of(problem, press, asked)
        if error <= TOLERANCE:
            break
    else:
        return {"tolerance_asked": "none", "error": error}
    theirs, ours, rounds = [], [], 1 if quick else ROUNDS
    for _ in range(rounds):
        theirs.append(seconds_of(problem, press, asked)[0])
        begin = time.process_time()
        result = solve(default_solver(subject), *pose_hard_wall(subject, step, heights, TOLERANCE, 1))
        ours.append(time.process_time() - begin)
    certificate = result.record.certificate
    contact = pressure > 0
    return {
        "tolerance_asked": asked,
        "seconds": float(np.median(theirs)),
        "own_seconds": float(np.median(ours)),
        "ratio": float(np.median(np.divide(theirs, ours))),
        "own_transforms": result.record.transforms,
        "error": error,
        "own_error": max(certificate.max_contact_gap, certificate.penetration),
        "area": float(contact.mean()),
        "own_area": result.relative_contact_area,
        "differing": int(np.count_nonzero(contact != result.contact)),
        "rounds": rounds,
    }


def cases(quick: bool) -> Iterator[dict]:
    """Single loads, coarse grids first."""
    sizes = (128,) if quick else (512, 1024)
    for points, name, hurst_exponent, pressure in itertools.product(sizes, PEERS, (0.8, 0.2), (1e-3, 1e-2, 1e-1)):
        if find_spec(PEERS[name][0]):
            yield {"peer": name, "hurst_exponent": hurst_exponent, "points": points, "reduced_pressure": pressure}


BENCHMARK = Benchmark(
    "free_surfaces",
    case=("peer", "hurst_exponent", "points", "reduced_pressure"),
    found=(
        *("tolerance_asked", "seconds", "own_seconds", "ratio", "own_transforms", "error", "own_error"),
        *("area", "own_area", "differing", "rounds"),
    ),
    table={
        "points": ("points along a side", "{:.0f}"),
        "peer": ("code", "{}"),
        "hurst_exponent": ("H", "{:g}"),
        "reduced_pressure": ("p*", "{:g}"),
        "seconds": ("theirs (s)", "{:.3g}"),
        "own_seconds": ("ours (s)", "{:.3g}"),
        "ratio": ("theirs ÷ ours", "{:.3g}"),
        "error": ("error (steps)", "{:.1e}"),
    },
    order=("points", "peer", "hurst_exponent"),
)

if __name__ == "__main__":
    BENCHMARK.run(__doc__, cases, compare)
