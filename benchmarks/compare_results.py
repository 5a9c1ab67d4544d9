"""Compare two folders of results number by number, across a change of names.

    python benchmarks/compare_results.py OLD NEW

`renamed.yaml` beside this file maps old names to new ones and lists the texts, digests and times that may differ. Runs
and decisions lie in folders that are named after a digest of their settings, so they are matched by their content
within a study and member. The exit code is 1 if a number differs, or if something is missing.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr
import yaml
from renaming import Renaming

TABLE = Path(__file__).with_name("renamed.yaml")
SKIPPED = ("logs/", "costs/", "bundle/", "report.html")
KINDS = (".nc", ".csv", ".json", ".yaml")
MATCHED = ("runs/", "decisions/")
"""Folders in which a digest of settings is a part of the path."""


@dataclass
class Differences:
    """What differs between two files: numbers fail, and the others are counted by their reason."""

    numbers: list[str] = field(default_factory=list)
    explained: Counter = field(default_factory=Counter)
    equal: int = 0

    def add(self, renaming: Renaming, name: str, what: str) -> None:
        """Note that something differs: as explained, if the table has a reason, or else as a failure."""
        if reason := renaming.reason(name):
            self.explained[f"{reason} of {name}"] += 1
        else:
            self.numbers.append(f"{name}: {what}")

    def merge(self, other: Differences, place: str) -> None:
        """Add the differences of a part."""
        self.numbers += [f"{place}: {text}" for text in other.numbers]
        self.explained += other.explained
        self.equal += other.equal


def compare_names(old: Iterable[str], new: Iterable[str], renaming: Renaming) -> Differences:
    """Compare the names, already translated, that two files have."""
    found, old, new = Differences(), set(old), set(new)
    for names, reasons, what in ((old - new, renaming.removed, "missing"), (new - old, renaming.added, "new")):
        for name in sorted(names):
            if name in reasons:
                found.explained[f"{name} {what}: {reasons[name]}"] += 1
            else:
                found.add(renaming, name, f"{what}, which no table explains")
    return found


def compare_datasets(old: Path, new: Path, renaming: Renaming) -> Differences:
    """Compare two netCDF files: variables bit for bit, with their dimensions and attributes."""
    before, after = (xr.load_dataset(path, decode_cf=False) for path in (old, new))
    names = {renaming.name(str(name)): str(name) for name in before.variables}
    found = compare_names(names, map(str, after.variables), renaming)
    for name in sorted(names.keys() & after.variables.keys()):
        one, other = before.variables[names[name]], after.variables[name]
        if difference := _difference(one, other, renaming):
            found.add(renaming, name, difference)
        else:
            found.equal += 1
        _compare_attributes(one.attrs, other.attrs, renaming, found, name)
    _compare_attributes(before.attrs, after.attrs, renaming, found, "the dataset")
    return found


def _difference(one: xr.Variable, other: xr.Variable, renaming: Renaming) -> str | None:
    """Return in words how two variables differ, None if they are equal bit for bit."""
    dims = tuple(renaming.name(str(dim)) for dim in one.dims)
    if (dims, one.shape) != (other.dims, other.shape):
        return f"{dict(zip(dims, one.shape, strict=True))} in place of {dict(other.sizes)}"
    first, second = np.asarray(one.values), np.asarray(other.values)
    if first.dtype.kind in "OUS" or second.dtype.kind in "OUS":
        texts = [renaming.value(str(text)) for text in first.ravel()]
        unlike = [pair for pair in zip(texts, map(str, second.ravel()), strict=True) if pair[0] != pair[1]]
        return f"{len(unlike)} texts, such as {unlike[0][0]!r} and {unlike[0][1]!r}" if unlike else None
    if first.dtype != second.dtype:
        return f"{first.dtype} in place of {second.dtype}"
    if first.tobytes() == second.tobytes():
        return None
    unlike = ~((first == second) | (np.isnan(first) & np.isnan(second)) if first.dtype.kind == "f" else first == second)
    if not unlike.any():
        return "signs of zero or kinds of NaN"
    largest = np.abs(np.asarray(second, float) - np.asarray(first, float))[unlike].max()
    return f"{np.count_nonzero(unlike)} of {first.size} numbers, by up to {largest:.3g}"


def _compare_attributes(old: dict, new: dict, renaming: Renaming, found: Differences, name: str) -> None:
    for key in sorted(old.keys() | new.keys()):
        texts = [repr(np.asarray(attrs.get(key)).tolist()) for attrs in (old, new)]
        if key not in old and key in renaming.added:
            found.explained[f"{key} new: {renaming.added[key]}"] += 1
        elif texts[0] != texts[1]:
            found.add(renaming, key, f"attribute of {name}: {texts[0]:.80} in place of {texts[1]:.80}")


def compare_tables(old: Path, new: Path, renaming: Renaming) -> Differences:
    """Compare two CSV files, in which rows and columns may come in another order."""
    before, after = (_columns(path) for path in (old, new))
    # a word that one table renamed and another has always had keeps its name where the new table has it
    renamed = {
        name: name if name in after and renaming.name(name) not in after else renaming.name(name) for name in before
    }
    own = {cell for cells in after.values() for cell in cells}
    before = {
        renamed[name]: [
            cell if cell in own and renaming.value(cell) not in own else renaming.value(cell) for cell in cells
        ]
        for name, cells in before.items()
    }
    found = compare_names(before, after, renaming)
    names = sorted(before.keys() & after.keys())
    compared = [name for name in names if renaming.reason(name) is None]
    rows, others = ([*zip(*(table[name] for name in compared), strict=True)] for table in (before, after))
    if rows != others and Counter(rows) == Counter(others):
        found.explained["order of rows"] += 1
        return found
    for name in names:
        unlike = [pair for pair in zip(before[name], after[name], strict=False) if pair[0] != pair[1]]
        if unlike or len(before[name]) != len(after[name]):
            found.add(renaming, name, f"{len(unlike)} of {len(before[name])} cells, such as {unlike[:1]}")
        else:
            found.equal += 1
    return found


def _columns(path: Path) -> dict[str, list[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return {name: [row[place] for row in rows] for place, name in enumerate(header)}


def compare_mappings(old: Path, new: Path, renaming: Renaming) -> Differences:
    """Compare two JSON or YAML files."""
    before, after = (yaml.safe_load(path.read_text(encoding="utf-8")) for path in (old, new))
    one, other = _leaves(before, renaming), _leaves(after, Renaming())
    found = compare_names({key for key, _ in one}, {key for key, _ in other}, renaming)
    for key in sorted({key for key, _ in one} & {key for key, _ in other}):
        if [value for name, value in one if name == key] != [value for name, value in other if name == key]:
            found.add(renaming, key, "other values")
        else:
            found.equal += 1
    return found


def _leaves(content: object, renaming: Renaming, key: str = "") -> list[tuple[str, str]]:
    """Return all values of nested mappings and lists, each with its innermost key."""
    if isinstance(content, dict):
        parts = [(renaming.name(str(name)), part) for name, part in content.items()]
        return [(key, str(sorted(name for name, _ in parts)))] * bool(key) + [
            leaf for name, part in sorted(parts, key=lambda item: item[0]) for leaf in _leaves(part, renaming, name)
        ]
    if isinstance(content, list):
        return [leaf for part in content for leaf in _leaves(part, renaming, key)]
    return [(key, renaming.value(content) if isinstance(content, str) else json.dumps(content))]


COMPARISONS = {".nc": compare_datasets, ".csv": compare_tables, ".json": compare_mappings, ".yaml": compare_mappings}


def compare_files(old: Path, new: Path, renaming: Renaming) -> Differences:
    """Compare two files of one kind."""
    return COMPARISONS[old.suffix](old, new, renaming)


def _files(folder: Path) -> list[str]:
    paths = (str(path.relative_to(folder)) for path in folder.rglob("*") if path.suffix in KINDS)
    return sorted(path for path in paths if not path.startswith(SKIPPED))


def _group(path: str) -> str:
    """Return a path without the digest of settings in it."""
    first, study, digest, *rest = path.split("/")
    return "/".join((first, study, *(rest or [Path(digest).suffix])))


def match_files(old: Path, new: Path, renaming: Renaming) -> tuple[list[tuple[str, str]], list[str], list[str]]:
    """Return pairs of files, old and new, and the files that only one of the trees has.

    Of runs and decisions, each old one is paired with the first new one of its study and member with its content, or
    else with one that is left.
    """
    pairs: list[tuple[str, str]] = []
    missing, left = [], dict.fromkeys(_files(new))
    waiting = []
    for path in _files(old):
        target = renaming.path(path)
        if not target.startswith(MATCHED) and target in left:
            pairs.append((path, target))
            left.pop(target)
        else:
            waiting.append((path, target))
    apart = []
    for path, target in waiting:
        candidates = [other for other in left if target.startswith(MATCHED) and other.startswith(MATCHED)]
        candidates = [other for other in candidates if _group(other) == _group(target)]
        same = (other for other in candidates if not compare_files(old / path, new / other, renaming).numbers)
        if match := next(same, None):
            pairs.append((path, match))
            left.pop(match)
        else:
            apart.append((path, target))
    for path, target in apart:
        groups = (other for other in left if other.startswith(MATCHED) and target.startswith(MATCHED))
        if match := next((other for other in groups if _group(other) == _group(target)), None):
            pairs.append((path, match))
            left.pop(match)
        else:
            missing.append(path)
    return pairs, missing, list(left)


def compare_results(old: Path, new: Path, renaming: Renaming, part: bool = False) -> tuple[Differences, list[str]]:
    """Compare two folders of results; return the differences, and files that only the new one has.

    part: True if the new folder holds only a part of the files.
    """
    pairs, missing, added = match_files(old, new, renaming)
    found = Differences(numbers=[] if part else [f"{path}: missing" for path in missing])
    for one, other in pairs:
        found.merge(compare_files(old / one, new / other, renaming), other)
    return found, added


def main(arguments: list[str] | None = None) -> int:
    """Print what differs; return 1 if a number does."""
    parser = argparse.ArgumentParser(description="Compare two folders of results number by number.")
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--table", type=Path, default=TABLE, help="table of names, in place of renamed.yaml")
    parser.add_argument("--part", action="store_true", help="the new folder is a part: let files be missing")
    options = parser.parse_args(arguments)
    found, added = compare_results(options.old, options.new, Renaming.read(options.table), options.part)
    for what, count in sorted(found.explained.items()):
        print(f"may differ: {what} ({count} times)")
    for path in added:
        print(f"new file: {path}")
    for text in found.numbers:
        print(f"DIFFERS: {text}")
    print(f"{found.equal} variables, columns and keys are equal; {len(found.numbers)} differ")
    return 1 if found.numbers else 0


if __name__ == "__main__":
    sys.exit(main())
