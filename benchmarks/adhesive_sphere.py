"""Pull-off and contact radius of a sphere alone on a half-space, from DMT to JKR, beside the exact answers.

    python benchmarks/adhesive_sphere.py          # --quick: a coarse grid, and nothing here changes

The law is exponential. Its tail is longer than Dugdale's, of which Maugis's model is, so the two differ where neither
DMT nor JKR holds. The contact ends where the traction is largest.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator

import numpy as np
from tabulated import Benchmark

import contactsim as cs
from contactsim.observables.surface_adhesion import negative_area
from contactsim.reference import adhesive_sphere as exact

MODULUS, WORK, RADIUS = 1.0, 1.0, 1000.0
SIZES, POINTS = (0.1, 0.3, 1.0, 2.0, 3.0, 5.0), (64, 128, 256, 512)
LEAST_ZONE_STEPS = 1.9
"""Grid steps in the process zone below which a grid is left out."""
TAIL = 8.0
"""Gap at the ends of the area, in the law's length."""
UNIT = (3 * np.pi * WORK * RADIUS**2 / (4 * MODULUS)) ** (2 / 3) / RADIUS
"""Approach by which those of JKR and Maugis are measured, nm."""
PLACES = (1.0, 0.5, 0.3, 0.2, 0.1, 0.05, 0.0, -0.05, -0.1, -0.15, -0.2, -0.3, -0.5)
"""Approaches beside that of the pull-off by Maugis, over `UNIT`."""
READ_AT = 3
"""Place among these at which the contact radius is read."""


def law_of(size: float) -> cs.NormalCohesiveZone:
    """The law with a given parameter of Maugis."""
    strength = size / exact.maugis_parameter(WORK, RADIUS, MODULUS, 1.0)
    return cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=WORK / (np.e * strength))


def length_of(size: float) -> float:
    """Side of the area, nm: at its ends the undeformed gap is `TAIL` lengths of the law, outside of the contact."""
    contact = np.sqrt(RADIUS * UNIT) * 1.45
    return float(2 * np.sqrt(contact**2 + 2 * RADIUS * TAIL * law_of(size).normal_length))


def pull(case: dict, quick: bool) -> dict:
    """Pull the sphere off, and read the largest pull off a parabola through the three largest."""
    del quick
    size, points = case["maugis_parameter"], case["points"]
    law, length = law_of(size), length_of(size)
    _, forces, approaches = exact.maugis_states(WORK, RADIUS, MODULUS, law.strength)
    places = approaches[np.argmin(forces)] + UNIT * np.array(PLACES)
    scene = cs.Scene(
        cs.FreeHalfSpace(MODULUS), cs.Sphere(radius=RADIUS, length=length), law, cs.approaches(places.tolist())
    )
    begin = time.process_time()
    data = cs.simulate(scene, points=points, tolerance=1e-5, snapshots=[places[READ_AT]])
    seconds = time.process_time() - begin
    force, least = data.normal_force.values, int(np.nanargmin(data.normal_force.values))
    if not 0 < least < force.size - 1:
        raise RuntimeError(f"the largest pull at {size:g} is at an end of the path")
    around = slice(least - 1, least + 2)
    square, slope, constant = np.polyfit(places[around] - places[least], force[around], 2)
    step = length / points
    area = negative_area(data.normal_gap.isel(snapshot=-1).values - law.normal_length, (step, step))
    sizes = np.linspace(0.5, 2.0, 20001) * np.sqrt(RADIUS * UNIT)
    wanted = np.interp(places[READ_AT], exact.jkr_approach(sizes, WORK, RADIUS, MODULUS), sizes)
    return {
        "zone_steps": float(1 / data.process_zone_step[0]),
        "pull_off": float(-(constant - slope**2 / (4 * square)) / (np.pi * WORK * RADIUS)),
        "maugis_pull_off": exact.maugis_pull_off(WORK, RADIUS, MODULUS, law.strength) / (np.pi * WORK * RADIUS),
        "radius_over_jkr": float(np.sqrt(area / np.pi) / wanted),
        "states": force.size,
        "failed": int((data.status != 0).sum()),
        "transforms": float(data.transforms.sum()),
        "seconds": seconds,
    }


def cases(quick: bool) -> Iterator[dict]:
    """Grids that resolve the process zone, coarse ones first."""
    for points, size in itertools.product(POINTS[:1] if quick else POINTS, SIZES):
        law = law_of(size)
        zone = np.e**2 * MODULUS * law.normal_length**2 / WORK
        if zone * points / length_of(size) >= LEAST_ZONE_STEPS:
            yield {"maugis_parameter": size, "points": points}


BENCHMARK = Benchmark(
    "adhesive_sphere",
    case=("maugis_parameter", "points"),
    found=(
        *("zone_steps", "pull_off", "maugis_pull_off", "radius_over_jkr", "states", "failed"),
        *("transforms", "seconds"),
    ),
    table={
        "maugis_parameter": ("Maugis's parameter", "{:g}"),
        "points": ("points along a side", "{:.0f}"),
        "zone_steps": ("steps in the process zone", "{:.2g}"),
        "pull_off": ("pull-off / πwR", "{:.4f}"),
        "maugis_pull_off": ("by Maugis", "{:.4f}"),
        "radius_over_jkr": ("radius over that of JKR", "{:.4f}"),
        "failed": ("failed states", "{:.0f}"),
        "transforms": ("transforms", "{:.0f}"),
        "seconds": ("CPU s", "{:.3g}"),
    },
)

if __name__ == "__main__":
    BENCHMARK.run(__doc__, cases, pull)
