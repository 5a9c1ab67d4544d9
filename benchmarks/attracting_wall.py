"""What it costs to press rough surfaces against a hard wall that attracts: the default solver in turns with tamaas.

    python benchmarks/attracting_wall.py          # --quick: a coarse grid, and nothing here changes

One mean pressure, from far apart. Both have the same exponential attraction. The error of a state is recomputed here
from its pressure alone, by numpy's transforms. Install tamaas first (README.md beside this file).
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator

import numpy as np
from tabulated import Benchmark

import contactsim as cs
from contactsim.grid import Array

LENGTH, MODULUS, TOLERANCE, BUDGET = 1024.0, 1.0, 1e-4, 20000
"""Period, nm; contact modulus, GPa; largest error; iterations of tamaas."""


def largest_error(heights: Array, pressure: Array, law: cs.ExponentialAttraction) -> float:
    """Return how far a pressure (n, n), with its pull, is from a state of a wall that attracts.

    At each point the smaller one of two numbers counts: the gap over the length of the law, and what the wall bears
    over its strength; a pull of the wall counts in full. The smallest gap is zero.
    """
    n = len(heights)
    q = 2 * np.pi * np.hypot(np.fft.fftfreq(n, LENGTH / n)[:, None], np.fft.rfftfreq(n, LENGTH / n))
    compliance = np.divide(2 / MODULUS, q, out=np.zeros_like(q), where=q > 0)
    gap = np.fft.irfft2(compliance * np.fft.rfft2(pressure), heights.shape) - heights
    gap -= gap.min()
    bearing = (pressure + law.traction(gap.reshape(1, -1)).reshape(heights.shape)) / law.strength
    return float(np.maximum(np.minimum(bearing, gap / law.normal_length), -bearing).max())


def pressed_by_tamaas(heights: Array, law: cs.ExponentialAttraction, mean_pressure: float) -> Array:
    """Return the pressure (n, n) of tamaas's conjugate gradients."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)
    model = tamaas.Model(tamaas.model_type.basic_2d, [LENGTH, LENGTH], list(heights.shape))
    model.E, model.nu = MODULUS, 0.0
    kinds = tamaas.PolonskyKeerRey.gap, tamaas.PolonskyKeerRey.pressure
    solver = tamaas.PolonskyKeerRey(model, heights, 1e-2 * TOLERANCE, *kinds)
    solver.max_iter = BUDGET
    solver.dump_freq = BUDGET
    attraction = tamaas.ExponentialAdhesionFunctional(heights)
    attraction.parameters = {"rho": law.normal_length, "surface_energy": law.work_of_separation}
    solver.addFunctionalTerm(attraction)
    solver.solve(mean_pressure)
    return np.array(model.traction).reshape(heights.shape)


def compare(case: dict, quick: bool) -> dict:
    """Press one surface with both codes."""
    del quick
    law, points = cs.ExponentialAttraction(case["work"], case["reach"]), case["points"]
    surface = cs.SelfAffine(LENGTH, 0.8, LENGTH / 2, LENGTH / 32, rms_gradient=0.15, dimensions=2, seed=1)
    heights, mean = surface.heights(points), case["reduced_pressure"] * 0.15
    begin = time.process_time()
    theirs = pressed_by_tamaas(heights, law, mean)
    seconds = time.process_time() - begin
    scene = cs.Scene(cs.HalfSpace(MODULUS), surface, (cs.HardWall(), law), cs.pressures([mean]))
    begin = time.process_time()
    data = cs.simulate(scene, points=points, tolerance=TOLERANCE, snapshots=[mean])
    own_seconds = time.process_time() - begin
    own = -data.normal_traction.values.reshape(heights.shape)
    return {
        "seconds": seconds,
        "own_seconds": own_seconds,
        "ratio": seconds / own_seconds,
        "own_transforms": float(data.transforms.sum()),
        "error": largest_error(heights, theirs, law),
        "own_error": largest_error(heights, own, law),
        "own_area": float(data.relative_repulsive_area[0]),
    }


def cases(quick: bool) -> Iterator[dict]:
    """Weak and strong attraction, light and heavy loads, coarse grids first."""
    sizes = (64,) if quick else (256, 512)
    for points, work, pressure in itertools.product(sizes, (0.02, 0.1), (0.02, 0.1)):
        yield {"work": work, "reach": 4.0, "reduced_pressure": pressure, "points": points}


BENCHMARK = Benchmark(
    "attracting_wall",
    case=("work", "reach", "reduced_pressure", "points"),
    found=("seconds", "own_seconds", "ratio", "own_transforms", "error", "own_error", "own_area"),
    table={
        "points": ("points along a side", "{:.0f}"),
        "work": ("w (N/m)", "{:g}"),
        "reduced_pressure": ("p*", "{:g}"),
        "seconds": ("theirs (s)", "{:.3g}"),
        "own_seconds": ("ours (s)", "{:.3g}"),
        "ratio": ("theirs ÷ ours", "{:.3g}"),
        "own_transforms": ("our transforms", "{:.0f}"),
        "error": ("error of theirs", "{:.1e}"),
        "own_error": ("of ours", "{:.1e}"),
        "own_area": ("area in contact", "{:.4f}"),
    },
    order=("points", "work", "reduced_pressure"),
)

if __name__ == "__main__":
    BENCHMARK.run(__doc__, cases, compare)
