"""Pull-off and contact radius of a sphere alone on a half-space, from DMT to JKR, beside the exact answers.

    python benchmarks/adhesive_sphere.py          # --quick: a coarse grid, and nothing here changes

The law is exponential. Its tail is longer than Dugdale's, of which Maugis's model is, so the two differ where neither
DMT nor JKR holds. The contact ends where the traction is largest.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from records import Table, on_one_thread
from report import insert, markdown

import contactsim as cs
from contactsim.observables.surface_adhesion import negative_area
from contactsim.reference import adhesive_sphere as exact

HERE = Path(__file__).resolve().parent
MODULUS, WORK, RADIUS = 1.0, 1.0, 1000.0
CASE = ("maugis_parameter", "points")
FOUND = (
    *("zone_steps", "pull_off", "maugis_pull_off", "radius_over_jkr", "states", "failed"),
    *("jumps", "transforms", "seconds"),
)
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
BEGIN, END = "<!-- adhesive sphere: written by adhesive_sphere.py -->", "<!-- end of adhesive sphere -->"
"""Marks of the table in the README."""


def law_of(size: float) -> cs.NormalCohesiveZone:
    """The law with a given parameter of Maugis."""
    strength = size / exact.maugis_parameter(WORK, RADIUS, MODULUS, 1.0)
    return cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=WORK / (np.e * strength))


def length_of(size: float) -> float:
    """Side of the area, nm: at its ends the undeformed gap is `TAIL` lengths of the law, outside of the contact."""
    contact = np.sqrt(RADIUS * UNIT) * 1.45
    return float(2 * np.sqrt(contact**2 + 2 * RADIUS * TAIL * law_of(size).normal_length))


def pull(case: dict) -> dict:
    """Pull the sphere off, and read the largest pull off a parabola through the three largest."""
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
        "jumps": int((data.jump > 0).sum()),
        "transforms": float(data.transforms.sum()),
        "seconds": seconds,
    }


def cases(points: tuple[int, ...]) -> Iterator[dict]:
    """Grids that resolve the process zone, coarse ones first."""
    for count, size in itertools.product(points, SIZES):
        law = law_of(size)
        zone = np.e**2 * MODULUS * law.normal_length**2 / WORK
        if zone * count / length_of(size) >= LEAST_ZONE_STEPS:
            yield {"maugis_parameter": size, "points": count}


TABLE = {
    "maugis_parameter": ("Maugis's parameter", "{:g}"),
    "points": ("points along a side", "{:.0f}"),
    "zone_steps": ("steps in the process zone", "{:.2g}"),
    "pull_off": ("pull-off / πwR", "{:.4f}"),
    "maugis_pull_off": ("by Maugis", "{:.4f}"),
    "radius_over_jkr": ("radius over that of JKR", "{:.4f}"),
    "failed": ("failed states", "{:.0f}"),
    "transforms": ("transforms", "{:.0f}"),
    "seconds": ("CPU s", "{:.3g}"),
}
"""Columns of the table in the README: their heads and forms."""


def write_table() -> None:
    """Put what has been measured into the README."""
    rows = pd.read_csv(HERE / "adhesive_sphere.csv").sort_values(list(CASE)).to_dict("records")
    lines = [[form.format(row[name]) for name, (_, form) in TABLE.items()] for row in rows]
    insert(HERE / "README.md", BEGIN, markdown([head for head, _ in TABLE.values()], lines), END)


def main() -> None:
    """Measure what is missing."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a coarse grid, in a temporary folder")
    options = parser.parse_args()
    on_one_thread()
    logging.getLogger("contactsim").setLevel(logging.ERROR)
    folder = Path(tempfile.mkdtemp()) if options.quick else HERE
    table = Table(folder / "adhesive_sphere.csv", CASE, FOUND)
    for case in cases(POINTS[:1] if options.quick else POINTS):
        table.row(case, pull)
        if not options.quick:
            write_table()


if __name__ == "__main__":
    main()
