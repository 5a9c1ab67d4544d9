"""Benchmarks run with the package as it is: each can be imported, and draws its picture from its table."""

from __future__ import annotations

import shutil
import sys
from importlib import import_module

import pytest

from contactsim.study.plan import Plan
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


def test_a_pair_has_the_columns_of_the_table_and_both_solutions_agree():
    plan = Plan.read(ROOT / "config", "standard")
    case = {"points": 512, "hurst_exponent": 0.8, "member": 0, "reduced_pressure": 0.01, "tolerance": 1e-3}
    row = import_module("pairs").compare(plan, case | {"solver": "polonsky_keer"}, 1, "")
    assert row["status"] == "CONVERGED"
    assert set(row) <= set(import_module("surface_solvers").FOUND)
    assert max(row["certificate"], row["own_certificate"]) <= case["tolerance"]
    assert row["area"] == pytest.approx(row["own_area"], abs=1e-5)
    assert row["differing"] == row["undecided"]
