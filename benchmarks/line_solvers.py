"""What line contacts cost: the default solver over all loads, and beside other solvers at single loads.

    pip install -e .[benchmark]
    python benchmarks/line_solvers.py            # about half an hour; --quick: ten seconds, and nothing here changes

Cost is counted in transforms, in equivalents of one on the finest grid, and timed in CPU seconds on one thread.
Surfaces, loads and tolerance are those of `rough_line` in config/ch3.yaml. Each row goes to the CSV as soon as it is
measured, and what stands there is not measured again: remove the file to start anew.
"""

from __future__ import annotations

import argparse
import csv
import itertools
import logging
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import measure
import report

from contactsim.plan import Plan
from contactsim.solvers import installed

HERE = Path(__file__).resolve().parent
CASE = ("part", "solver", "hurst", "points", "member", "reduced_pressure", "tolerance")
FOUND = ("status", "area", "certificate", "transforms", "seconds", "rounds")
RATIOS = ("seconds_of_transforms", "per_transforms", "seconds_of_replay", "per_replay", "per_active_set")
SIZES = (2**14, 2**15, 2**16, 2**17, 2**18)
COMPARED = (1e-3, 1e-2, 1e-1)

logger = logging.getLogger("line_solvers")


class Table:
    """Rows of a CSV file, each written when it is found; a row found before is not looked for again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.exists():
            path.write_text(",".join(CASE + FOUND + RATIOS) + "\n")
        with path.open(newline="") as lines:
            self._known = {tuple(row[name] for name in CASE): row for row in csv.DictReader(lines)}

    def row(self, case: dict, find: Callable[[dict], dict]) -> dict:
        """The row of a case, as text."""
        name = tuple(str(case.get(key, "")) for key in CASE)
        if name not in self._known:
            found = find(case)
            found = {key: f"{value:.6g}" if isinstance(value, float) else str(value) for key, value in found.items()}
            self._known[name] = dict(zip(CASE, name, strict=True)) | found
            with self.path.open("a", newline="") as lines:
                csv.DictWriter(lines, CASE + FOUND + RATIOS).writerow(self._known[name])
            logger.info("%s: %s", " ".join(name), " ".join(f"{key} {value}" for key, value in found.items()))
        return self._known[name]


def sweeps(plan: Plan, table: Table, sizes: tuple[int, ...], members: int, rounds: int) -> None:
    """The active set over all loads at each Hurst exponent, size and tolerance."""
    study = plan.studies["rough_line"].settings
    tolerances = study["tolerance"], 1e-6
    for hurst, points, tolerance in itertools.product(study["vary"]["surface.hurst"], sizes, tolerances):
        for member in range(members):
            case = {"part": "sweep", "solver": "active_set", "hurst": hurst, "points": points, "member": member}
            table.row(case | {"tolerance": tolerance}, lambda case: measure.sweep(plan, case, rounds))


def comparisons(sizes: tuple[int, ...], solvers: tuple[str, ...], hursts: tuple[float, ...]) -> Iterator[dict]:
    """Every single load to solve: quickest grids first; time stepping on the coarsest only."""
    for hurst, points, pressure, name in itertools.product(hursts, sizes, COMPARED, solvers):
        if name != "verlet" or points == min(SIZES):
            case = {"part": "compare", "solver": name, "hurst": hurst, "points": points, "member": 0}
            yield case | {"reduced_pressure": pressure}


def compared(plan: Plan, table: Table, sizes: tuple[int, ...], hursts: tuple[float, ...], rounds: int) -> None:
    """Single loads with every solver."""
    solvers = ("active_set", "polonsky_keer", "verlet", "tamaas")
    if not installed("tamaas"):
        logger.warning("tamaas is not installed and left out: pip install -e .[benchmark]")
        solvers = solvers[:-1]
    tolerance = plan.studies["rough_line"].settings["tolerance"]
    for case in comparisons(sizes, solvers, hursts):
        table.row(case | {"tolerance": tolerance}, lambda case: measure.compare(plan, case, rounds))


def main() -> None:
    """Measure what is missing, then make the table and the picture."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="coarse grids and one round, in a temporary folder")
    parser.add_argument("--redraw", action="store_true", help="measure nothing: table and picture from the CSV")
    options = parser.parse_args()
    if os.environ.get("OMP_NUM_THREADS") != "1":  # read when numpy is loaded, hence the new start
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | {"OMP_NUM_THREADS": "1"})
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    plan = Plan.read(HERE.parent / "config", "standard")
    folder = Path(tempfile.mkdtemp()) if options.quick else HERE
    table = Table(folder / "line_solvers.csv")
    if not options.redraw:
        sizes, members, rounds = (SIZES[:2], 1, 1) if options.quick else (SIZES, 3, 3)
        sweeps(plan, table, sizes, members, rounds)
        compared(plan, table, sizes[::2], (0.8,) if options.quick else (0.8, 0.2), rounds)
    report.write(table.path, folder / "line_solvers.png", folder / "README.md")
    logger.info("written to %s", folder)


if __name__ == "__main__":
    main()
