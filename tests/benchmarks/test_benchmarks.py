"""Benchmarks run with the package as it is: each can be imported, and draws its picture from its table."""

from __future__ import annotations

import shutil
import sys
from importlib import import_module

import pytest

from support.places import ROOT

FOLDER = ROOT / "benchmarks"
sys.path.insert(0, str(FOLDER))


@pytest.mark.parametrize("name", sorted(path.stem for path in FOLDER.glob("*.py")))
def test_a_benchmark_can_be_imported(name):
    assert import_module(name).__doc__


@pytest.mark.parametrize(("module", "name"), [("report", "line_solvers"), ("surface_report", "surface_solvers")])
def test_tables_and_picture_are_drawn_from_the_measurements(tmp_path, module, name):
    readme, picture = tmp_path / "README.md", tmp_path / "picture.png"
    shutil.copy(FOLDER / "README.md", readme)
    import_module(module).write(FOLDER / f"{name}.csv", picture, readme)
    assert picture.stat().st_size > 10_000
    assert readme.read_text(encoding="utf-8").startswith("# Benchmarks")
