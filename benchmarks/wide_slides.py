"""Slides far beyond those that the relations of error control were measured on, solved to a wanted error and judged.

    python benchmarks/wide_slides.py          # --quick: one slide, and nothing here changes

Bodies are half-spaces and layers of 0.05 to 1 radius; radii, periods, moduli, works, ratios of both lengths and depths
are drawn from ranges of up to a factor of 25. The judge has twice the points, and increments of at most a quarter.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from tabulated import Benchmark

import contactsim as cs
from contactsim.error_control.control import solve_to_error
from contactsim.error_control.options import scale_increment, set_grid
from contactsim.error_control.solution import solve_setup
from contactsim.errors import InputError
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested

SEED, SCENES = 592356, 60
ERRORS = (0.005, 0.01, 0.02, 0.05)
"""Wanted errors, in turns."""
NAME = "static_friction"
JUDGE_INCREMENT = 0.06
"""Longest increment of the judge, nm."""


def draw_slide(count: int) -> cs.Scene:
    """Return one slide by its number."""
    rng = np.random.default_rng([SEED, count])

    def wide(low: float, high: float) -> float:
        """Return a number between two bounds with four digits, uniform in its logarithm."""
        return float(f"{np.exp(rng.uniform(*np.log([low, high]))):.4g}")

    radius = wide(2000.0, 50000.0)
    modulus, ratio = wide(20.0, 200.0), float(rng.uniform(0.1, 0.5))
    thickness = wide(0.05, 1.0) * radius
    body = cs.HalfSpace(modulus, ratio) if rng.uniform() < 0.4 else cs.Layer(modulus, ratio, thickness)
    law = cs.CohesiveZone(wide(0.3, 5.0), float(rng.uniform(0.1, 1.0)), 1.0, wide(0.5, 2.0))
    depth = float(rng.uniform(-1.0, 8.0))
    path = cs.approaches([-2.0, depth], 0.5) >> cs.sliding([0.0, 10.0], 0.5, approach=depth)
    return cs.Scene(body, cs.Cylinder(radius * wide(0.3, 3.0), radius), law, path)


def judge_slide(case: dict, quick: bool) -> dict:
    """Solve a slide to its error, and say how far a finer run is from it."""
    del quick
    scene, wanted = draw_slide(case["count"]), case["wanted"]
    try:
        result = solve_to_error(Setup(scene), wanted, (NAME,))
    except InputError:  # it does not slide within its 10 nm
        return {}
    last = result.last.setup
    factor = min(0.25, JUDGE_INCREMENT / last.scene.path.increment)
    tight = scale_increment(last.with_options(tolerance=1e-5, increments=Requested()), factor)
    judge = solve_setup(set_grid(tight, 2.0 * last.points), (NAME,))
    return {
        "reached": int(result.met),
        "true_error": float(abs(result.last.values[NAME] / judge.values[NAME] - 1).item()),
        "estimated_error": float(result.errors[NAME].item()),
        "points": last.points,
        "increment": last.scene.path.increment,
        "runs": len(result.before) + 1,
        "seconds": result.seconds,
    }


def cases(quick: bool) -> Iterator[dict]:
    """All slides, each with its error."""
    for count in range(1 if quick else SCENES):
        yield {"count": count, "wanted": ERRORS[count % len(ERRORS)]}


BENCHMARK = Benchmark(
    "wide_slides",
    case=("count", "wanted"),
    found=("reached", "true_error", "estimated_error", "points", "increment", "runs", "seconds"),
    table={
        "count": ("slide", "{:.0f}"),
        "wanted": ("wanted", "{:g}"),
        "reached": ("reached", "{:.0f}"),
        "true_error": ("true error", "{:.2g}"),
        "estimated_error": ("estimate", "{:.2g}"),
        "points": ("points", "{:.0f}"),
        "runs": ("runs", "{:.0f}"),
        "seconds": ("CPU s", "{:.2g}"),
    },
)

if __name__ == "__main__":
    BENCHMARK.run(__doc__, cases, judge_slide)
