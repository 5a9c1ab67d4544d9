"""Mutants: small errors are put into the package one at a time, to see which test notices each.

    python benchmarks/mutants.py [--own] [NAME ...]    # all of mutants.yaml by default; --own: their own tests alone

A mutant is one wrong factor, sign, end of a range or rule. It is put into a copy of the tree. Its own tests run first,
then, if they do not notice it, all that are not slow. `mutants.csv` has what came of each.
"""

from __future__ import annotations

import csv
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[1]
TABLE, RESULTS = (Path(__file__).with_name(f"mutants.{kind}") for kind in ("yaml", "csv"))
PACKAGE = "src/contactsim"
LEFT_OUT = (".git", ".venv", "results", ".snakemake", "__pycache__", ".*_cache", ".hypothesis", "*.egg-info")
"""What is not copied."""
NOT_SLOW = ("-m", "not slow")
PYTEST = ("-m", "pytest", "-x", "-n", "0", "-p", "no:cacheprovider")
OWN_LIMIT, LIMIT = 300, 1800
"""Seconds after which a mutant hangs, in its own tests and in all."""
KILLED, HANGS, SURVIVED = "killed", "hangs", "survived"
COLUMNS = ("name", "file", "outcome", "test")


@dataclass(frozen=True)
class Mutant:
    """An error in one place of a file.

    name: what is wrong; file: below `PACKAGE`; tests: its own, below `tests`; old, new: the text and the wrong one.
    """

    name: str
    file: str
    tests: tuple[str, ...]
    old: str
    new: str

    @property
    def names_tests(self) -> bool:
        """True if its own tests are named one by one, so that slow ones run too."""
        return any("::" in test for test in self.tests)

    @property
    def own_tests(self) -> list[str]:
        """The arguments of pytest that run its own tests."""
        return [*(() if self.names_tests else NOT_SLOW), *(f"tests/{test}" for test in self.tests)]

    def mutated(self, text: str) -> str:
        """Return the text of its file with the error; ValueError unless the old text stands there once."""
        if text.count(self.old) != 1 or self.old == self.new:
            raise ValueError(f"{self.name}: {self.file} has {text.count(self.old)} times {self.old!r}")
        return text.replace(self.old, self.new)


def read_mutants(names: list[str]) -> list[Mutant]:
    """Return the mutants of the table with these names, all without names."""
    table = yaml.safe_load(TABLE.read_text(encoding="utf-8"))
    if unknown := set(names) - set(table):
        raise ValueError(f"no mutants: {', '.join(sorted(unknown))}")
    mutants = [Mutant(name, **{**table[name], "tests": tuple(table[name]["tests"])}) for name in names or table]
    for mutant in mutants:
        mutant.mutated((ROOT / PACKAGE / mutant.file).read_text(encoding="utf-8"))
    return mutants


def run_tests(tree: Path, arguments: list[str], limit: float) -> tuple[str, str]:
    """Run tests in a copy of the tree; return the outcome and the first test that failed."""
    environment = os.environ | {"PYTHONPATH": f"{tree / 'src'}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"}
    command = [sys.executable, *PYTEST, *arguments]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    process = subprocess.Popen(command, cwd=tree, env=environment, start_new_session=True, **streams)
    try:
        text = process.communicate(timeout=limit)[0]
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # with the processes that tests have started
        process.communicate()
        return HANGS, ""
    if process.returncode == 0:
        return SURVIVED, ""
    failed = re.search(r"^(?:FAILED|ERROR) tests/(.+?)(?: - .*)?$", text, re.MULTILINE)
    if failed is None:
        raise RuntimeError(f"pytest ended with {process.returncode}:\n{text[-2000:]}")
    return KILLED, failed[1]


def try_mutant(mutant: Mutant, tree: Path, own_alone: bool) -> tuple[str, str]:
    """Return the outcome of a mutant and the test that noticed it; the tree is as before in the end."""
    path = tree / PACKAGE / mutant.file
    path.write_text(mutant.mutated(path.read_text(encoding="utf-8")), encoding="utf-8")
    try:
        outcome, test = run_tests(tree, mutant.own_tests, OWN_LIMIT)
        if outcome == SURVIVED and not own_alone:
            outcome, test = run_tests(tree, [*NOT_SLOW], LIMIT)
    finally:
        shutil.copy2(ROOT / PACKAGE / mutant.file, path)
    return outcome, test


def check_tests(tree: Path, mutants: list[Mutant]) -> None:
    """Raise RuntimeError unless the own tests of all mutants pass without a mutant."""
    together = {not_slow: [] for not_slow in (True, False)}
    for mutant in mutants:
        together[not mutant.names_tests] += [f"tests/{test}" for test in mutant.tests]
    for not_slow, paths in together.items():
        arguments = [*(NOT_SLOW if not_slow else ()), *dict.fromkeys(paths)]
        outcome, test = run_tests(tree, arguments, LIMIT) if paths else (SURVIVED, "")
        if outcome != SURVIVED:
            raise RuntimeError(f"without a mutant: {outcome} {test}")


def write_results(rows: dict[str, tuple[str, ...]]) -> None:
    """Write the outcomes of the mutants that are in the table, in its order."""
    with RESULTS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerows([COLUMNS, *(rows[name] for name in yaml.safe_load(TABLE.read_text("utf-8")) if name in rows)])


def main(names: list[str], own_alone: bool) -> None:
    """Try mutants, print what came of each, and write the table of outcomes."""
    mutants, rows = read_mutants(names), {}
    if RESULTS.exists():
        with RESULTS.open(encoding="utf-8", newline="") as file:
            rows = {row[0]: tuple(row) for row in list(csv.reader(file))[1:]}
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(*LEFT_OUT))
        check_tests(tree, mutants)
        for mutant in mutants:
            outcome, test = try_mutant(mutant, tree, own_alone)
            rows[mutant.name] = (mutant.name, mutant.file, outcome, test)
            print(f"{mutant.name}: {outcome} {test and f'by {test}'}".rstrip(), flush=True)
            write_results(rows)
    killed = sum(rows[mutant.name][2] != SURVIVED for mutant in mutants)
    print(f"{killed} of {len(mutants)} mutants are noticed")


if __name__ == "__main__":
    main([name for name in sys.argv[1:] if name != "--own"], "--own" in sys.argv)
