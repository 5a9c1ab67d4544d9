"""What line contacts cost: the default solver over all loads, and beside other solvers at single loads.

    pip install -e .[benchmark]
    python benchmarks/line_solvers.py            # about half an hour; --quick: ten seconds, and nothing here changes

Cost is counted in transforms, in equivalents of one on the finest grid, and timed in CPU seconds on one thread.
Surfaces, loads and tolerance are those of `rough_line` in config/ch3.yaml. Each row goes to the CSV as soon as it is
measured, and what stands there is not measured again: remove the file to start anew.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import tempfile
from collections.abc import Iterator
from pathlib import Path

import measure
import report
from records import Table, on_one_thread

from contactsim.solvers.registry import is_installed
from contactsim.study.plan import Plan

HERE = Path(__file__).resolve().parent
CASE = ("part", "solver", "hurst_exponent", "points", "member", "reduced_pressure", "tolerance")
FOUND = ("status", "area", "certificate", "transforms", "seconds", "rounds")
RATIOS = ("seconds_of_transforms", "per_transforms", "seconds_of_replay", "per_replay", "per_active_set")
SIZES = (2**14, 2**15, 2**16, 2**17, 2**18)
COMPARED = (1e-3, 1e-2, 1e-1)

logger = logging.getLogger("line_solvers")


def sweeps(plan: Plan, table: Table, sizes: tuple[int, ...], members: int, rounds: int) -> None:
    """The active set over all loads at each Hurst exponent, size and tolerance."""
    study = plan.studies["rough_line"].settings
    tolerances = study["tolerance"], 1e-6
    for hurst_exponent, points, tolerance in itertools.product(
        study["vary"]["surface.hurst_exponent"], sizes, tolerances
    ):
        for member in range(members):
            case = {
                "part": "sweep",
                "solver": "active_set",
                "hurst_exponent": hurst_exponent,
                "points": points,
                "member": member,
            }
            table.row(case | {"tolerance": tolerance}, lambda case: measure.measure_sweep(plan, case, rounds))


def comparisons(sizes: tuple[int, ...], solvers: tuple[str, ...], hursts: tuple[float, ...]) -> Iterator[dict]:
    """Every single load to solve: quickest grids first; time stepping on the coarsest only."""
    for hurst_exponent, points, pressure, name in itertools.product(hursts, sizes, COMPARED, solvers):
        if name != "verlet" or points == min(SIZES):
            case = {"part": "compare", "solver": name, "hurst_exponent": hurst_exponent, "points": points, "member": 0}
            yield case | {"reduced_pressure": pressure}


def compared(plan: Plan, table: Table, sizes: tuple[int, ...], hursts: tuple[float, ...], rounds: int) -> None:
    """Single loads with every solver."""
    solvers = ("active_set", "polonsky_keer", "verlet", "tamaas")
    if not is_installed("tamaas"):
        logger.warning("tamaas is not installed and left out: pip install -e .[benchmark]")
        solvers = solvers[:-1]
    tolerance = plan.studies["rough_line"].settings["tolerance"]
    for case in comparisons(sizes, solvers, hursts):
        table.row(case | {"tolerance": tolerance}, lambda case: measure.measure_pair(plan, case, rounds))


def main() -> None:
    """Measure what is missing, then make the table and the picture."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="coarse grids and one round, in a temporary folder")
    parser.add_argument("--redraw", action="store_true", help="measure nothing: table and picture from the CSV")
    options = parser.parse_args()
    on_one_thread()
    plan = Plan.read(HERE.parent / "config", "standard")
    folder = Path(tempfile.mkdtemp()) if options.quick else HERE
    table = Table(folder / "line_solvers.csv", CASE, FOUND + RATIOS)
    if not options.redraw:
        sizes, members, rounds = (SIZES[:2], 1, 1) if options.quick else (SIZES, 3, 3)
        sweeps(plan, table, sizes, members, rounds)
        compared(plan, table, sizes[::2], (0.8,) if options.quick else (0.8, 0.2), rounds)
    report.write(table.path, folder / "line_solvers.png", folder / "README.md")
    logger.info("written to %s", folder)


if __name__ == "__main__":
    main()
