"""What it costs to press rough adhesive surfaces: the default solver in turns with Adhesion, by the same law.

    python benchmarks/adhesive_surfaces.py          # --quick: a coarse grid, and nothing here changes

Both follow the same approaches, each state from the one before. In Adhesion the mean displacement is a spring; ours
follows the approaches that its states amount to. The law is that of Morse. The residual of every state is recomputed
here, by numpy's transforms. Install Adhesion first (README.md beside this file).
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from tabulated import Benchmark

import contactsim as cs
from contactsim.grid import Array

LENGTH, MODULUS, TOLERANCE = 1024.0, 1.0, 1e-4
"""Period, nm; contact modulus, GPa; largest residual over the strength."""
APPROACHES = tuple(np.arange(-18.0, -5.9, 0.5).tolist())
"""Approaches of the mean planes, nm."""


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


def compare(case: dict, quick: bool) -> dict:
    """Press one surface with both codes."""
    del quick
    law, points = Morse(case["work"], case["reach"]), case["points"]
    surface = cs.SelfAffine(LENGTH, 0.8, LENGTH / 2, LENGTH / 32, rms_height=5.0, dimensions=2, seed=1)
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


def cases(quick: bool) -> Iterator[dict]:
    """Long and short range, weak and strong, coarse grids first."""
    for points, reach, work in itertools.product((64,) if quick else (256, 512, 1024), (2.0, 1.0), (0.03, 0.3)):
        yield {"work": work, "reach": reach, "points": points}


BENCHMARK = Benchmark(
    "adhesive_surfaces",
    case=("work", "reach", "points"),
    found=(
        *("seconds", "own_seconds", "ratio", "own_transforms", "evaluations", "failed", "own_failed"),
        *("residual", "own_residual", "difference"),
    ),
    table={
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
    },
    order=("points", "reach", "work"),
)

if __name__ == "__main__":
    BENCHMARK.run(__doc__, cases, compare)
