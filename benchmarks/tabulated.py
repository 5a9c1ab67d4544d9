"""A benchmark whose rows stand in a CSV file and, as a table, between marks of the README."""

from __future__ import annotations

import argparse
import logging
import tempfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from records import Table, on_one_thread
from report import insert, markdown

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Benchmark:
    """A benchmark by its name, that of its script and of its CSV file.

    case: columns that name a row, by which the table is sorted unless `order` says otherwise; found: the others; table:
    head and form of each column of the README, in their order.
    """

    name: str
    case: tuple[str, ...]
    found: tuple[str, ...]
    table: Mapping[str, tuple[str, str]]
    order: tuple[str, ...] = ()

    def write_table(self) -> None:
        """Put what has been measured into the README."""
        rows = pd.read_csv(HERE / f"{self.name}.csv", na_values="none").sort_values(list(self.order or self.case))
        lines = [
            ["–" if pd.isna(row[name]) else form.format(row[name]) for name, (_, form) in self.table.items()]
            for row in rows.to_dict("records")
        ]
        words = self.name.replace("_", " ")
        begin, end = f"<!-- {words}: written by {self.name}.py -->", f"<!-- end of {words} -->"
        insert(HERE / "README.md", begin, markdown([head for head, _ in self.table.values()], lines), end)

    def run(self, text: str, cases: Callable[[bool], Iterable[dict]], find: Callable[[dict, bool], dict]) -> None:
        """Measure what is missing.

        text: what the script does; cases, find: rows to measure, and how; true asks for a quick trial, which leaves
        nothing behind.
        """
        parser = argparse.ArgumentParser(description=text.partition("\n")[0])
        parser.add_argument("--quick", action="store_true", help="a coarse grid, in a temporary folder")
        quick = parser.parse_args().quick
        on_one_thread()
        logging.getLogger("contactsim").setLevel(logging.ERROR)
        table = Table((Path(tempfile.mkdtemp()) if quick else HERE) / f"{self.name}.csv", self.case, self.found)
        for case in cases(quick):
            table.row(case, lambda case: find(case, quick))
            if not quick:
                self.write_table()
