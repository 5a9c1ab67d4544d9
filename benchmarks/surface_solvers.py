"""What surface contacts cost: the default solver in pairs with aspher's nested solver and with tamaas.

    python benchmarks/surface_solvers.py          # --quick: a coarse grid, and nothing here changes

Install the peers first (README.md beside this file). Surfaces are those of `rough_surface` in config/ch3.yaml, single
loads, to 1e-6 grid steps. First aspher's quickest settings that are certified are sought, then pairs are timed. The
largest grids are measured once, beside aspher alone, with its settings on the next coarser grid, whose tolerance is
tightened until it is certified. Each row goes to the CSV as soon as it is measured, and what stands there is not
measured again; `--again` measures the pairs anew, with the settings found before.
"""

from __future__ import annotations

import argparse
import itertools
import logging
import tempfile
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pairs
import surface_report
from records import Table, on_one_thread

from contactsim.study.plan import Plan

HERE = Path(__file__).resolve().parent
CASE = ("part", "solver", "hurst_exponent", "points", "reduced_pressure", "tolerance")
FOUND = (
    *("status", "settings", "rung", "area", "certificate", "transforms", "seconds", "per_transform"),
    *("own_area", "own_certificate", "own_transforms", "own_seconds", "own_per_transform", "ratio"),
    *("differing", "undecided", "largest_pressure", "largest_gap"),
    *("transform_seconds", "rounds", "load_average"),
)
PEERS = ("aspher", "tamaas")
FIRST_RUNG = 10
"""Where the search for aspher's tolerance begins: 1e-9."""
SIZES, PRESSURES, ROUNDS = (512, 1024, 2048), (1e-3, 1e-2, 1e-1), 3
LARGE = {4096: PRESSURES, 8192: PRESSURES[:2]}
"""Reduced pressures on the largest grids, by points along a side."""

logger = logging.getLogger("surface_solvers")


def cases(points: int, pressures: tuple[float, ...]) -> Iterator[dict]:
    """Single loads on a grid."""
    for hurst_exponent, pressure in itertools.product((0.8, 0.2), pressures):
        yield {
            "hurst_exponent": hurst_exponent,
            "points": points,
            "member": 0,
            "reduced_pressure": pressure,
            "tolerance": 1e-6,
        }


def measured(plan: Plan, table: Table, sizes: tuple[int, ...], rounds: int) -> None:
    """All cases with every peer that is installed."""
    found = [name for name in PEERS if find_spec(name)]
    for name in sorted({*PEERS} - {*found}):
        logger.warning("%s is not installed and left out: see README.md", name)
    rung = FIRST_RUNG
    for case in (case for points in sizes for case in cases(points, PRESSURES)):
        for name in found:
            pair, settings = case | {"part": "pair", "solver": name}, ""
            if name == "aspher":
                sought = table.row(pair | {"part": "search"}, lambda case, rung=rung: pairs.search(plan, case, rung))
                settings, rung = sought["settings"], int(sought["rung"])
            table.row(pair, lambda case, settings=settings: pairs.compare(plan, case, rounds, settings))


def measured_once(plan: Plan, table: Table) -> None:
    """The largest grids beside aspher, whose settings on the next coarser grid are in the table."""
    if not find_spec("aspher"):
        return
    for case in (case for points, pressures in LARGE.items() for case in cases(points, pressures)):
        one = case | {"part": "search", "solver": "aspher"}
        coarser = table.known(one | {"points": case["points"] // 2})["settings"]
        settings = table.row(one, lambda case, coarser=coarser: pairs.tighten(plan, case, coarser))["settings"]
        table.row(one | {"part": "pair"}, lambda case, settings=settings: pairs.compare(plan, case, 1, settings))


def main() -> None:
    """Measure what is missing, then make the table and the picture."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a coarse grid and one round, in a temporary folder")
    parser.add_argument("--again", action="store_true", help="time all pairs anew, with the settings found before")
    parser.add_argument("--redraw", action="store_true", help="measure nothing: table and picture from the CSV")
    options = parser.parse_args()
    on_one_thread()
    plan = Plan.read(HERE.parent / "config", "standard")
    folder = Path(tempfile.mkdtemp()) if options.quick else HERE
    table = Table(folder / "surface_solvers.csv", CASE, FOUND)
    if options.again:
        table.forget("pair")
    if not options.redraw:
        measured(plan, table, SIZES[:1] if options.quick else SIZES, 1 if options.quick else ROUNDS)
    if not (options.redraw or options.quick):
        measured_once(plan, table)
    surface_report.write(table.path, folder / "surface_solvers.png", folder / "README.md")
    logger.info("written to %s", folder)


if __name__ == "__main__":
    main()
