from __future__ import annotations

import contextlib
import re
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from contactsim import cli, dataset
from contactsim.analysis.table_comparison import FIT_DIMENSIONS, difference_text, differences, is_within, join_rows
from contactsim.errors import InputError
from contactsim.study.plan import Plan
from contactsim.study.tier_comparison import compare_tiers
from support.places import ROOT

COARSE = pd.DataFrame({"hurst_exponent": [0.2, 0.2, 0.8], "load": [0.1, 0.5, 0.1], "kappa": [1.1, 9.0, 3.0]})
FINE = pd.DataFrame({"hurst_exponent": [0.8, 0.2, 0.2], "load": [0.1, 0.1, 0.3], "kappa": [2.0, 1.0, 7.0]})
KEYS = ["hurst_exponent", "load"]


def test_rows_are_joined_by_their_keys_and_those_of_one_alone_are_left_out():
    shared = join_rows(COARSE, FINE, KEYS)
    assert shared.index.to_list() == [(0.2, 0.1), (0.8, 0.1)]
    assert shared["first", "kappa"].to_list() == [1.1, 3.0]
    assert shared["second", "kappa"].to_list() == [1.0, 2.0]


@pytest.mark.parametrize(("factor", "rows"), [(1 + 1e-15, 2), (1 - 9e-7, 2), (1 + 2e-6, 0), (1 - 2e-6, 0)])
def test_keys_are_the_same_up_to_a_millionth(factor, rows):
    assert len(join_rows(COARSE, FINE.assign(load=FINE.load * factor), KEYS)) == rows


def test_words_and_whole_numbers_are_keys_too():
    one = pd.DataFrame({"fitted": ["0.2", "all"], "member": [0, 1], "kappa": [1.0, 2.0]})
    shared = join_rows(one, one.iloc[::-1].assign(member=[1.0, 0.0]), ["fitted", "member"])
    assert shared["first", "kappa"].to_list() == shared["second", "kappa"].to_list() == [1.0, 2.0]


@pytest.mark.parametrize("keys", [["hurst_exponent"], []])
def test_keys_that_do_not_tell_rows_apart_are_refused(keys):
    with pytest.raises(InputError, match="tell all rows apart"):
        join_rows(COARSE, FINE, keys)


def test_differences_are_relative_to_the_second_and_say_where_the_largest_is():
    (row,) = differences(join_rows(COARSE, FINE, KEYS), ["kappa"]).to_dict("records")
    assert (row["column"], row["rows"], row["at"]) == (
        "kappa",
        2,
        "hurst_exponent 0.8",
    )  # the load is the same in both rows
    assert row["largest"] == 0.5
    assert row["median"] == pytest.approx((0.1 + 0.5) / 2, rel=1e-14)  # 1.1 − 1.0 is rounded


@pytest.mark.parametrize(
    ("first", "second", "rows", "largest"),
    [
        (-1.0, -2.0, 1, 0.5),
        (0.0, 0.0, 1, 0.0),
        (1.0, 0.0, 1, np.inf),
        (np.nan, 1.0, 1, np.inf),
        (1.0, np.nan, 1, np.inf),
        (np.nan, np.nan, 0, np.nan),
    ],
)
def test_zero_and_missing_numbers_differ_infinitely_from_others(first, second, rows, largest):
    one, two = (pd.DataFrame({"load": [0.1], "kappa": [value]}) for value in (first, second))
    found = differences(join_rows(one, two, ["load"]), ["kappa"])
    assert found.rows[0] == rows
    assert np.array_equal(found.largest, [largest], equal_nan=True)
    assert is_within(found, 0.1) == (largest == 0)


def test_without_a_shared_row_nothing_is_within_the_limit():
    found = differences(join_rows(COARSE, FINE.assign(load=9.0 + FINE.index), KEYS), ["kappa"])
    assert found.rows[0] == 0
    assert not is_within(found, 0.1)
    assert "none" in difference_text({"fig": found}, 0.1)


def test_the_summary_is_aligned_and_gives_each_figure_a_verdict():
    found = differences(join_rows(COARSE, FINE, KEYS), ["kappa"])
    assert difference_text(
        {"fig_1": found, "fig_2": found.assign(largest=0.0, at=""), "fig_3": None}, 0.1
    ).splitlines() == [
        "  column   rows   largest    median  largest at",
        "fig_1: beyond 10 %",
        "  kappa       2      50 %      30 %  hurst_exponent 0.8",
        "fig_2: within 10 %",
        "  kappa       2       0 %      30 %",
        "fig_3: not compared, its settings name no columns",
    ]


# --- the figures of this project ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def quick():
    return Plan.read(ROOT / "config", "quick")


def test_the_figures_have_the_columns_that_they_compare_and_equal_themselves(made, quick, monkeypatch):
    monkeypatch.chdir(made)
    for name, table in compare_tiers(quick, quick).items():
        if table is None:  # a figure without studies: tiers do not differ
            continue
        assert list(table.column) == quick.figures[name].compare
        shown = pd.read_csv(f"results/quick/figures/{name}.csv")
        assert table.rows.tolist() == [shown[column].notna().sum() for column in table.column]
        assert (table.largest == 0).all()


def test_the_dimensions_of_fits_are_those_of_the_dataset(made):
    assert dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc").fit_b1.dims == FIT_DIMENSIONS


@pytest.fixture
def tiers(made, tmp_path, monkeypatch):
    """A folder where the standard tier's figures equal the quick tier's; returns a function that edits one's CSV."""
    shutil.copytree(ROOT / "config", tmp_path / "config")
    for tier in ("quick", "standard"):
        (tmp_path / f"results/{tier}/figures").mkdir(parents=True)
        for file in (made / "results/quick/figures").glob("*.csv"):
            shutil.copy(file, tmp_path / f"results/{tier}/figures")
    monkeypatch.chdir(tmp_path)

    def change(edit, name="fig_3_2", tier="quick"):
        path = f"results/{tier}/figures/{name}.csv"
        edit(pd.read_csv(path)).to_csv(path, index=False)

    return change


def exit_code(*arguments):
    """What the shell gets: 0, or what the command says as it stops."""
    try:
        cli.main(["compare", "quick", "standard", *arguments])
    except SystemExit as stop:
        return stop.code
    return 0


def test_one_changed_value_turns_the_verdict_and_the_exit_code(tiers, capsys):
    assert exit_code() == 0
    assert "beyond" not in capsys.readouterr().out

    def raise_sixth(table):
        sixth = table.kappa_mean.dropna().index[5]
        return table.assign(kappa_mean=table.kappa_mean.where(table.index != sixth, 1.2 * table.kappa_mean))

    tiers(raise_sixth)
    assert exit_code() == 1
    said = capsys.readouterr().out
    assert "fig_3_2: beyond 10 %" in said
    assert said.count("beyond") == 1
    line, *_ = (line for line in said.splitlines() if line.startswith("  kappa_mean "))
    assert line.split()[1:6] == ["12", "20", "%", "0", "%"]
    assert line.endswith("hurst_exponent 0.5, reduced_pressure 0.00351")
    assert exit_code("--within", "0.21") == 0
    assert "fig_3_2: within 21 %" in capsys.readouterr().out


def test_only_shared_loads_are_compared(tiers, capsys):
    tiers(lambda table: table[table.reduced_pressure < 0.05])
    assert exit_code() == 0
    assert re.search(r"^  kappa_mean +9 ", capsys.readouterr().out, re.MULTILINE)


def test_what_both_tiers_have_is_compared_and_what_is_missing_is_named(tiers, tmp_path, capsys):
    (tmp_path / "results/standard/figures/fig_3_2.csv").unlink()
    (tmp_path / "results/quick/figures/fig_3_3.csv").unlink()
    assert exit_code() == 0
    said = capsys.readouterr().out
    assert "fig_3_4: within 10 %" in said
    assert "fig_3_2:" not in said and "fig_3_3:" not in said
    assert said.endswith(
        "Missing at the tier quick: fig_3_3. Make them with: make NAME TIER=quick\n"
        "Missing at the tier standard: fig_3_2. Make them with: make NAME TIER=standard\n"
    )


def test_tiers_without_a_common_figure_are_refused(tiers, tmp_path):
    for file in (tmp_path / "results/standard/figures").glob("*.csv"):
        file.unlink()
    said = exit_code()
    assert said.startswith("Error: quick and standard have no figure in common.\nMissing at the tier standard: ")
    assert "fig_3_2" in said


@pytest.mark.parametrize(
    ("column", "words"),
    [
        ("kappa_mean", ["got 'kappa_mean'", "kappa_r_mean", "`make fig_3_2 TIER=quick`"]),
        ("reduced_pressure", ["figures.fig_3_2.key columns", "got ['hurst_exponent']", "tell all rows apart"]),
    ],
)
def test_a_missing_column_is_refused_in_one_line_that_names_the_file(tiers, column, words):
    tiers(lambda table: table.drop(columns=column))
    said = exit_code()
    assert said.startswith("Error: results/quick/figures/fig_3_2.csv")
    assert "\n" not in said
    assert all(word in said for word in words)


def test_a_figure_without_columns_to_compare_needs_no_file(tiers, tmp_path, capsys):
    config = tmp_path / "config/ch3.yaml"
    text = config.read_text(encoding="utf-8")
    config.write_text(text.replace("    compare: [kappa_fit, kappa_fit_corrected]\n", ""), encoding="utf-8")
    (tmp_path / "results/quick/figures/fig_3_3.csv").unlink()
    assert exit_code() == 0
    assert "fig_3_3: not compared, its settings name no columns" in capsys.readouterr().out


def test_columns_that_identify_rows_cannot_be_compared(tiers, tmp_path):
    config = tmp_path / "config/ch3.yaml"
    text = config.read_text(encoding="utf-8")
    config.write_text(
        text.replace("compare: [kappa_fit, kappa_fit_corrected]", "compare: [fit_limit]"), encoding="utf-8"
    )
    assert "figures.fig_3_3.compare: got 'fit_limit'" in exit_code()


def test_results_that_were_kept_are_compared_as_a_tier_is(tiers, capsys):
    shutil.copytree("results/quick", "kept")
    assert exit_code() == 0
    said = capsys.readouterr().out
    with contextlib.suppress(SystemExit):
        cli.main(["compare", "kept", "standard"])
    assert capsys.readouterr().out == said.replace("quick", "kept")
    Path("kept/figures/fig_3_2.csv").unlink()
    with contextlib.suppress(SystemExit):
        cli.main(["compare", "kept", "standard"])
    assert "Missing in kept: fig_3_2\n" in capsys.readouterr().out


def test_an_unknown_tier_is_refused(tiers):
    with pytest.raises(SystemExit, match="got 'huge'; allowed: one of quick, standard, full"):
        cli.main(["compare", "quick", "huge"])
