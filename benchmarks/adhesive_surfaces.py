"""What it costs to press rough adhesive surfaces: the default solver in turns with Adhesion, by the same law.

    python benchmarks/adhesive_surfaces.py          # --quick: a coarse grid, and nothing here changes

Both follow the same approaches, each state from the one before. In Adhesion the mean displacement is a spring; ours
follows the approaches that its states amount to. The law is that of Morse. The residual of every state is recomputed
here, by numpy's transforms. Install Adhesion first (README.md beside this file).
"""

from __future__ import annotations

import argparse
import itertools
import logging
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from records import Table, on_one_thread
from report import insert, markdown

import contactsim as cs
from contactsim.grid import Array

HERE = Path(__file__).resolve().parent
CASE = ("work", "reach", "points")
FOUND = (
    *("seconds", "own_seconds", "ratio", "own_transforms", "evaluations", "failed", "own_failed"),
    *("residual", "own_residual", "difference"),
)
LENGTH, MODULUS, TOLERANCE = 1024.0, 1.0, 1e-4
"""Period, nm; contact modulus, GPa; largest residual over the strength."""
APPROACHES = tuple(np.arange(-18.0, -5.9, 0.5).tolist())
"""Approaches of the mean planes, nm."""
BEGIN, END = "<!-- adhesive surfaces: written by adhesive_surfaces.py -->", "<!-- end of adhesive surfaces -->"
"""Marks of the table in the README."""


@dataclass(frozen=True)
class Morse(cs.NormalCohesiveZone):
    """Traction 2w/r (exp(-g/r) - exp(-2g/r)) of the gap g, r the normal length."""

    @property
    def strength(self) -> float:
        """Largest pull, GPa."""
        return self.work_of_separation / self.normal_length / 2

    def tangent(self, gap: Array) -> tuple[Array, Array]:
        """Return the traction (1, n) and its slope (1, 1, n)."""
        far = np.exp(-gap[0] / self.normal_length)
        scale = 2 * self.work_of_separation / self.normal_length
        return (scale * (far - far**2))[None], (scale / self.normal_length * (2 * far**2 - far))[None, None]

    def traction(self, gap: Array) -> Array:
        """Return the traction (1, n)."""
        return self.tangent(gap)[0]

    def energy(self, gap: Array) -> Array:
        """Return the energy (n,)."""
        far = np.exp(-gap[0] / self.normal_length)
        return self.work_of_separation * (far**2 - 2 * far)


def largest_residual(heights: Array, displacement: Array, approach: float, law: Morse) -> float:
    """Largest traction that nothing balances, over the strength; the uniform one is that of the approach."""
    n = len(heights)
    q = 2 * np.pi * np.hypot(np.fft.fftfreq(n, LENGTH / n)[:, None], np.fft.rfftfreq(n, LENGTH / n))
    gap = displacement - heights - approach
    traction = law.traction(gap.reshape(1, -1)).reshape(heights.shape)
    elastic = np.fft.irfft2(np.fft.rfft2(displacement) * q * MODULUS / 2, heights.shape)
    unbalanced = elastic + traction - traction.mean()
    return float(np.abs(unbalanced).max() / law.strength)


def pressed_by_adhesion(heights: Array, law: Morse) -> tuple[list[Array], int]:
    """Displacements (ny, nx) of the lower surface at all approaches, upwards, and evaluations of the energy."""
    from Adhesion.Interactions import Morse as TheirMorse
    from Adhesion.System import SmoothContactSystem
    from ContactMechanics import PeriodicFFTElasticHalfSpace
    from SurfaceTopography import Topography

    sizes = (LENGTH, LENGTH)
    substrate = PeriodicFFTElasticHalfSpace(heights.shape, MODULUS, sizes)
    interaction = TheirMorse(law.work_of_separation, law.normal_length)
    system = SmoothContactSystem(substrate, interaction, Topography(heights.copy(), sizes, periodic=True))
    area = (LENGTH / len(heights)) ** 2
    start, states, evaluations = np.zeros(heights.shape), [], 0
    for approach in APPROACHES:
        found = system.minimize_proxy(
            offset=approach,
            initial_displacements=start,
            options={
                **{"gtol": 0.5 * TOLERANCE * law.strength * area, "ftol": 0.0, "maxcor": 3},
                **{"maxiter": 100000, "maxfun": 300000},
            },
        )
        evaluations += int(found.nfev)
        start = np.array(found.x).reshape(heights.shape)
        states.append(start)
    return states, evaluations


def compare(case: dict) -> dict:
    """Press one surface with both codes."""
    law, points = Morse(case["work"], case["reach"]), case["points"]
    surface = cs.SelfAffine(
        LENGTH, 0.8, LENGTH / 2, LENGTH / 32, rms_height=5.0, dimensions=2, seed=case.get("seed", 1)
    )
    heights = surface.heights(points)
    begin = time.process_time()
    theirs, evaluations = pressed_by_adhesion(heights, law)
    seconds = time.process_time() - begin
    places = [approach - float(field.mean()) for approach, field in zip(APPROACHES, theirs, strict=True)]
    theirs = [field - field.mean() for field in theirs]
    scene = cs.Scene(cs.HalfSpace(MODULUS), surface, law, cs.approaches(places))
    begin = time.process_time()
    data = cs.simulate(scene, points=points, tolerance=TOLERANCE, snapshots=places)
    own_seconds = time.process_time() - begin
    own = [-state.normal_displacement.values for _, state in data.groupby("snapshot", squeeze=False)]
    own = [np.asarray(field).reshape(heights.shape) for field in own]
    residuals, own_residuals = (
        [largest_residual(heights, field, at, law) for field, at in zip(states, places, strict=True)]
        for states in (theirs, own)
    )
    last = [law.traction((fields[-1] - heights - places[-1]).reshape(1, -1)).mean() for fields in (theirs, own)]
    return {
        "seconds": seconds,
        "own_seconds": own_seconds,
        "ratio": seconds / own_seconds,
        "own_transforms": float(data.transforms.sum()),
        "evaluations": evaluations,
        "failed": int(np.count_nonzero(np.array(residuals) > TOLERANCE)),
        "own_failed": int(np.count_nonzero(np.array(own_residuals) > TOLERANCE)),
        "residual": max(residuals),
        "own_residual": max(own_residuals),
        "difference": float(abs(last[0] - last[1]) / abs(last[1])),
    }


def cases(points: tuple[int, ...]) -> Iterator[dict]:
    """Long and short range, weak and strong, coarse grids first."""
    for count, reach, work in itertools.product(points, (2.0, 1.0), (0.03, 0.3)):
        yield {"work": work, "reach": reach, "points": count}


TABLE = {
    "points": ("points along a side", "{:.0f}"),
    "reach": ("r (nm)", "{:g}"),
    "work": ("w (N/m)", "{:g}"),
    "seconds": ("theirs (s)", "{:.3g}"),
    "own_seconds": ("ours (s)", "{:.3g}"),
    "ratio": ("theirs ÷ ours", "{:.3g}"),
    "evaluations": ("their evaluations", "{:.0f}"),
    "own_transforms": ("our transforms", "{:.0f}"),
    "failed": ("theirs not within the tolerance", "{:.0f}"),
    "own_failed": ("ours", "{:.0f}"),
    "difference": ("difference of the last load", "{:.1e}"),
}
"""Columns of the table in the README: their heads and forms."""


def write_table() -> None:
    """Put what has been measured into the README."""
    rows = pd.read_csv(HERE / "adhesive_surfaces.csv").sort_values(["points", "reach", "work"]).to_dict("records")
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
    table = Table(folder / "adhesive_surfaces.csv", CASE, FOUND)
    for case in cases((64,) if options.quick else (256, 512, 1024)):
        table.row(case, compare)
        if not options.quick:
            write_table()


if __name__ == "__main__":
    main()
