"""What paths of rough adhesive lines cost: the default solver beside mass-weighted Verlet, at equal error.

    python benchmarks/rough_paths.py    # three minutes

Thirty-one approaches in steps of 1 nm, each state from the one before, in turns in one process on one thread. An error
is the largest difference of the mean pressure over the largest one, or of the length in contact over the longest one,
whichever is larger, from a path of the default solver in steps of 1/64 nm to a tolerance of 1e-6. So a jump that comes
a step early counts in full.

The ratio is that of CPU times at equal error: of each Verlet path the time, and of the default solver that of its
cheapest path with at most that error. A path that is in the CSV is not measured again.
"""

from __future__ import annotations

import itertools
import logging
import time
from pathlib import Path

import numpy as np
from records import Table, on_one_thread
from report import insert, markdown

from contactsim import HalfSpace, NormalCohesiveZone, Scene, SelfAffine, approaches, simulate
from contactsim.grid import Array
from contactsim.solvers.registry import make_solver

FOLDER = Path(__file__).resolve().parent
SIZES, HURST_EXPONENTS, WORKS = (1024, 4096, 16384), (0.2, 0.8), (3.5, 10.5)
TOLERANCES, ROUNDS = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), 3
STEPS, FINER = 31, 64
MODULUS = 70 / (1 - 0.45**2)
DEFAULT, OTHER = "newton", "mass_weighted_verlet"
CASE = ("points", "hurst_exponent", "work", "solver", "tolerance")
FOUND = ("error", "transforms", "seconds", "solved")
BEGIN, END = "<!-- rough paths: written by rough_paths.py -->", "<!-- end of rough paths -->"

logger = logging.getLogger("rough_paths")


def scene(case: dict, finer: int = 1) -> Scene:
    """Return a rough line that is brought from before first touch into contact, in steps of 1 nm or finer ones."""
    surface = SelfAffine(
        10240.0,
        case["hurst_exponent"],
        long_cutoff=1280.0,
        short_cutoff=80.0,
        rms_height=10.0,
        seed=1,
    )
    path = approaches(-6.5 + np.arange((STEPS - 1) * finer + 1) / finer)
    return Scene(HalfSpace(contact_modulus=MODULUS), surface, NormalCohesiveZone(case["work"]), path)


def follow(case: dict, solver: str, tolerance: float, finer: int = 1) -> tuple[Array, dict]:
    """Return mean pressure and length in contact of the steps of 1 nm (2, steps), and what the path cost."""
    begin = time.thread_time()
    options = {"points": case["points"], "tolerance": tolerance, "solver": make_solver(solver), "keep_fields": False}
    data = simulate(scene(case, finer), **options)
    spent = time.thread_time() - begin
    solved = int((data.status == 0).sum())
    curves = np.stack([data.mean_pressure.values, data.contact_length.values])[:, ::finer]
    return curves, {"transforms": float(data.transforms.sum()), "seconds": spent, "solved": solved}


def measure(case: dict, reference: Array) -> dict:
    """Return the error of a path and its cost, the least of some rounds."""
    rounds = [follow(case, case["solver"], case["tolerance"]) for _ in range(ROUNDS if case["points"] < 16384 else 1)]
    curves, cost = min(rounds, key=lambda found: found[1]["seconds"])
    largest = np.abs(reference).max(axis=1)
    error = float((np.abs(curves - reference).max(axis=1) / largest).max())
    return {"error": error} | cost


def rows_of(table: Table, case: dict) -> list[list[str]]:
    """Return the rows of a case: one for each tolerance."""
    reference: list[Array] = []

    def find(one: dict) -> dict:
        """Measure a path; the reference is solved when it is first needed."""
        if not reference:
            reference.append(follow(case, DEFAULT, 1e-6, FINER)[0])
        return measure(one, reference[0])

    found = {
        (solver, tolerance): table.row(case | {"solver": solver, "tolerance": tolerance}, find)
        for tolerance, solver in itertools.product(TOLERANCES, (DEFAULT, OTHER))
    }
    own = [found[DEFAULT, tolerance] for tolerance in TOLERANCES]
    rows = []
    for tolerance in TOLERANCES:
        ours, theirs = found[DEFAULT, tolerance], found[OTHER, tolerance]
        as_good = [float(row["seconds"]) for row in own if float(row["error"]) <= float(theirs["error"])]
        ratio = f"{min(as_good) / float(theirs['seconds']):.2f}" if as_good else ""
        start = [f"{case['points']}", f"{case['hurst_exponent']:g}", f"{case['work'] / 70:g}", f"{tolerance:g}"]
        each = [f"{float(row[name]):.3g}" for name in ("error", "transforms", "seconds") for row in (ours, theirs)]
        rows.append([*start, *each, ratio])
    return rows


def main() -> None:
    """Measure all cases and put their table into the README."""
    on_one_thread()
    table = Table(FOLDER / "rough_paths.csv", CASE, FOUND)
    header = ["points", "H", "φn*", "tolerance"]
    header += [f"{name}, {solver}" for name in ("error", "transforms", "CPU s") for solver in ("default", "Verlet")]
    rows = [
        row
        for points, hurst_exponent, work in itertools.product(SIZES, HURST_EXPONENTS, WORKS)
        for row in rows_of(table, {"points": points, "hurst_exponent": hurst_exponent, "work": work})
    ]
    insert(FOLDER / "README.md", BEGIN, markdown([*header, "default ÷ Verlet at equal error"], rows), END)


if __name__ == "__main__":
    main()
