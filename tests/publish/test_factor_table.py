"""The table of κ and κ_r in the limit of fine grids."""

import json

import numpy as np
import pytest

from contactsim import dataset
from contactsim.analysis.uncertainty import Estimate, student_factor
from contactsim.publish import factor_table
from support.claims import PLAN, made_up, with_corrected


def test_each_factor_stands_with_the_errors_of_a_statement(monkeypatch, tmp_path):
    data = with_corrected(made_up(scatter=0.01), 1.9, change=0.02, subgrid=1.83)
    data["kappa_corrected"] = data.kappa - 0.1
    renamed = {f"kappa{end}": f"kappa_r{end}" for end in ("_corrected", "_subgrid", "_corrected_grid_change")}
    data = data.merge(data[list(renamed)].rename(renamed) / 2)
    monkeypatch.setattr(factor_table, "load_dataset", lambda path: data)
    head, _, *rows = factor_table.factor_table(PLAN, tmp_path, "rough_line").splitlines()
    assert head == "| p* | members | κ, H = 0.2 | κ, H = 0.8 | κ_r, H = 0.2 | κ_r, H = 0.8 |"
    assert [row.split(" | ")[0] for row in rows] == ["| 0.001", "| 0.01", "| 0.1"]
    count, *cells = rows[0].strip("| ").split(" | ")[1:]
    assert count == "4"
    values = [[float(part) for part in cell.split(" ± ")] for cell in cells]
    spread = student_factor(4) * np.std(0.01 * np.linspace(-1, 1, 4), ddof=1) / 2
    assert values[0] == values[1] == pytest.approx([1.9, spread, 0.07], rel=0.15)  # the second estimator decides
    assert values[2] == pytest.approx([0.95, spread / 2, 0.035], rel=0.15)


def test_loads_that_more_members_have_show_their_mean_and_the_others_the_few(monkeypatch, tmp_path):
    levels = {"rough_line": 1.9, "rough_line_many": 1.6}
    members = {"rough_line": 4, "rough_line_many": 40}
    studies = {}
    for name, level in levels.items():
        data = with_corrected(made_up(members=members[name]), level, change=0.02, subgrid=level)
        own = {"name": name, "same_surfaces_as": "rough_line"}
        studies[name] = data.assign_attrs(settings=json.dumps(dataset.settings_of(data) | own))
    many = studies["rough_line_many"]  # the first four are 0.3 below their fine grid, and the others 0.5 below these
    many["kappa_corrected"] = many.kappa_corrected - 0.5 * (many.member >= 4)
    studies["rough_line_many"] = many.sel(reduced_pressure=[0.001, 0.1])
    monkeypatch.setattr(factor_table, "FACTORS", {"kappa_corrected": "κ"})
    monkeypatch.setattr(factor_table, "load_dataset", lambda path: studies[path.stem.partition("_")[2]])
    _, _, *rows = factor_table.factor_table(PLAN, tmp_path, "rough_line", ["rough_line_many"]).splitlines()
    cells = [row.strip("| ").split(" | ")[1:3] for row in rows]
    assert [(count, float(cell.split(" ± ")[0])) for count, cell in cells] == [
        ("40", pytest.approx(1.45, abs=0.01)), ("4", 1.9), ("40", pytest.approx(1.45, abs=0.01)),
    ]  # fmt: skip


def test_a_grid_error_that_is_small_by_chance_takes_those_beside_it():
    errors = [0.02, 0.0, 0.02, 0.02]
    pooled = factor_table.pool_grid_errors([Estimate(1.7, 0.01, error) for error in errors])
    assert [part.grid_error for part in pooled] == pytest.approx(
        [0.02 / np.sqrt(2), 0.02 * np.sqrt(2 / 3), 0.02 * np.sqrt(2 / 3), 0.02]
    )
    assert {(part.value, part.ensemble_error) for part in pooled} == {(1.7, 0.01)}
