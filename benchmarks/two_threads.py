"""What a second thread gains on surfaces: the time of one load on one thread over that on two.

    python benchmarks/two_threads.py    # ten minutes, on a machine with two idle cores

The surfaces are those of `rough_surface` in config/ch3.yaml, one load to 1e-6 grid steps. Solutions take turns in one
process, and the certificate is part of them; the number is the median of the rounds, of which 8192² has one. A row that
is in the CSV is not measured again. OMP_NUM_THREADS must not be 1, or transforms have one thread only.
"""

from __future__ import annotations

import itertools
import logging
import time
from functools import partial
from pathlib import Path
from statistics import median

from measure import pose_case
from records import Table
from report import insert, markdown

from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.solvers.base import solve
from contactsim.solvers.registry import make_solver
from contactsim.study.plan import Plan

FOLDER = Path(__file__).resolve().parent
HURST_EXPONENTS, PRESSURES, TOLERANCE = (0.2, 0.8), (1e-3, 1e-2, 1e-1), 1e-6
ROUNDS = {2048: 3, 4096: 3, 8192: 1}
"""Rounds by points along a side."""
CASE, FOUND = ("points", "hurst_exponent", "reduced_pressure"), ("one", "two", "ratio")
BEGIN, END = "<!-- two threads: written by two_threads.py -->", "<!-- end of two threads -->"


def measure(plan: Plan, case: dict) -> dict:
    """Return the least seconds on one thread and on two, and the median ratio."""
    scene, heights = pose_case(plan, case | {"member": 0}, [case["reduced_pressure"]], "rough_surface")

    def seconds(threads: int) -> float:
        """Return the seconds of one solution."""
        problem, scale = pose_hard_wall(scene, scene.path.steps[0], heights, TOLERANCE, threads)
        begin = time.perf_counter()
        result = solve(make_solver("conjugate_gradients"), problem, scale)
        assert result.status.name == "CONVERGED"
        return time.perf_counter() - begin

    pairs = [(seconds(1), seconds(2)) for _ in range(ROUNDS[case["points"]])]
    one, two = map(min, zip(*pairs, strict=True))
    return {"one": one, "two": two, "ratio": median(first / second for first, second in pairs)}


def main() -> None:
    """Measure all cases and put their table into the README."""
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    plan = Plan.read(FOLDER.parent / "config", "standard")
    table = Table(FOLDER / "two_threads.csv", CASE, FOUND)
    rows = []
    for values in itertools.product(ROUNDS, HURST_EXPONENTS, PRESSURES):
        found = table.row(dict(zip(CASE, values, strict=True)), partial(measure, plan))
        numbers = [f"{float(found[name]):.3g}" for name in FOUND]
        rows.append([f"{values[0]}²", *(f"{value:g}" for value in values[1:]), *numbers])
    header = ["points", "H", "p*", "one thread (s)", "two threads (s)", "one ÷ two"]
    insert(FOLDER / "README.md", BEGIN, markdown(header, rows), END)


if __name__ == "__main__":
    main()
