"""Rows in a CSV file, kept from run to run, and the process in which they are measured."""

from __future__ import annotations

import csv
import logging
import os
import sys
from collections.abc import Callable
from pathlib import Path

logger = logging.getLogger("benchmarks")


class Table:
    """Rows of a CSV file, each written when it is found; a row found before is not looked for again."""

    def __init__(self, path: Path, case: tuple[str, ...], found: tuple[str, ...]) -> None:
        """case: columns that name a row; found: the others."""
        self.path, self._case, self._columns = path, case, case + found
        if not path.exists():
            path.write_text(",".join(self._columns) + "\n")
        with path.open(newline="") as lines:
            self._known = {tuple(row[name] for name in case): row for row in csv.DictReader(lines)}

    def known(self, case: dict) -> dict:
        """The row of a case that is in the file, as text; KeyError where it is not."""
        return self._known[self._name(case)]

    def _name(self, case: dict) -> tuple[str, ...]:
        """The columns that name a row, as text."""
        return tuple(str(case.get(key, "")) for key in self._case)

    def row(self, case: dict, find: Callable[[dict], dict]) -> dict:
        """The row of a case, as text."""
        name = self._name(case)
        if name not in self._known:
            found = find(case)
            found = {key: f"{value:.6g}" if isinstance(value, float) else str(value) for key, value in found.items()}
            self._known[name] = dict(zip(self._case, name, strict=True)) | found
            with self.path.open("a", newline="") as lines:
                csv.DictWriter(lines, self._columns).writerow(self._known[name])
            logger.info("%s: %s", " ".join(name), " ".join(f"{key} {value}" for key, value in found.items()))
        return self._known[name]

    def forget(self, part: str) -> None:
        """Drop the rows of a part, the first column."""
        self._known = {name: row for name, row in self._known.items() if name[0] != part}
        with self.path.open("w", newline="") as lines:
            writer = csv.DictWriter(lines, self._columns)
            writer.writeheader()
            writer.writerows(self._known.values())


def on_one_thread() -> None:
    """Start anew with one thread for all libraries, unless it is so; and log to the terminal."""
    if os.environ.get("OMP_NUM_THREADS") != "1":  # read when numpy is loaded, hence the new start
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | {"OMP_NUM_THREADS": "1"})
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
