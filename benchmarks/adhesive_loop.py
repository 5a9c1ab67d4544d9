"""A rough adhesive surface pressed and pulled off in 100 steps, and again in steps of 1/2, 1/4 and 1/8 of the length.

    python benchmarks/adhesive_loop.py          # --quick: a coarse grid, and nothing here changes

The surface is that of the study `adhesive_surface`, on twice its points along a side. The loops should have the same
loads, largest pull, largest jumps and dissipated energy but for the error of their steps.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator

import numpy as np
from tabulated import Benchmark

import contactsim as cs
from contactsim.error_control.solution import solve_setup
from contactsim.paths.options import Setup

TURNS, STEPS = (-26.0, -2.0, -32.0), 100
"""Approaches (nm) at which the loop begins, turns and ends, and its steps."""
SUMMARY = (
    *("pull_off_force_unloading", "dissipated_work", "dissipated_work_increment_error"),
    *("max_jump_loading", "max_jump_unloading"),
)
TOLERANCE = 1e-4
"""Largest residual, over the strength."""


def measure_loop(case: dict, quick: bool) -> dict:
    """One loop; `division` of a case: parts into which each of its steps is divided."""
    del quick
    surface = cs.SelfAffine(1024.0, 0.8, 512.0, 32.0, rms_height=5.0, dimensions=2, seed=1)
    law = cs.StiffCohesiveZone(work_of_separation=case["work"], contact_stiffness=0.3, normal_length=1.0)
    increment = sum(abs(after - before) for before, after in itertools.pairwise(TURNS)) / STEPS / case["division"]
    scene = cs.Scene(cs.HalfSpace(1.0), surface, law, cs.approaches(TURNS, increment))
    begin = time.process_time()
    loop = solve_setup(Setup(scene).with_options(points=case["points"], tolerance=TOLERANCE), SUMMARY)
    data = loop.data
    return {
        "states": data.step.size,
        "failed": int((data.status != 0).sum()),
        "transforms": loop.transforms,
        "seconds": time.process_time() - begin,
        "pressure_at_turn": float(data.mean_pressure.values[np.argmax(data.approach.values)]),
        **{name: float(values.item()) for name, values in loop.values.items()},
    }


def cases(quick: bool) -> Iterator[dict]:
    """Weak and strong adhesion, each in steps and in parts of them."""
    for work, divisions in ((0.03, (1, 2)), (0.3, (1, 2, 4, 8))):
        for division in divisions[:1] if quick else divisions:
            yield {"work": work, "points": 64 if quick else 512, "division": division}


BENCHMARK = Benchmark(
    "adhesive_loop",
    case=("work", "points", "division"),
    found=(
        *("states", "failed", "transforms", "seconds"),
        "pressure_at_turn",
        *SUMMARY,
    ),
    table={
        "work": ("work of adhesion (N/m)", "{:g}"),
        "states": ("states", "{:.0f}"),
        "failed": ("failed", "{:.0f}"),
        "transforms": ("transforms", "{:.0f}"),
        "seconds": ("CPU s", "{:.3g}"),
        "max_jump_loading": ("largest jump, loading (nm)", "{:.3g}"),
        "max_jump_unloading": ("largest jump, unloading (nm)", "{:.3g}"),
        "pressure_at_turn": ("pressure at the turn (GPa)", "{:.6f}"),
        "pull_off_force_unloading": ("largest pull (nN)", "{:.5g}"),
        "dissipated_work": ("dissipated energy (N/m)", "{:.3g}"),
        "dissipated_work_increment_error": ("its error (N/m)", "{:.2g}"),
    },
)

if __name__ == "__main__":
    BENCHMARK.run(__doc__, cases, measure_loop)
