"""Causes name the numbers of their row, do not repeat them by hand, and no statement that fails lacks one."""

from __future__ import annotations

import math
import re

import pandas as pd
import pytest

from contactsim.analysis.candidate_shares import FILE
from contactsim.analysis.causes import Cause, cause_text, claims_without_cause
from contactsim.analysis.cell_rules import CellRule, admitted_cells, cell_texts, separate_cells
from contactsim.analysis.claims import cause_numbers
from contactsim.analysis.more_members import Studies
from contactsim.analysis.reductions import ORDERS
from contactsim.analysis.verdict import DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED, band
from contactsim.errors import InputError
from contactsim.study.claim_plan import Claim
from contactsim.study.plan import Plan
from support.claims import claim, made_up
from support.places import ROOT

PLAN = Plan.read(ROOT / "config", "standard")
SETTINGS = {name: entry.settings for claims in PLAN.claims.values() for name, entry in claims.items()}
CAUSES = {name: Cause(**settings["cause"]) for name, settings in SETTINGS.items() if settings["cause"]}
SHIPPED = pd.read_csv(ROOT / "docs/gallery/verdicts.csv").set_index("claim", drop=False)
FIRST_ROW = ("value", "ensemble_error", "grid_error")
NUMBER = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)( %)?")
ROW = {
    "verdict": NOT_REPRODUCED,
    "margin": 3.21,
    "beside_margin": math.nan,
    "value": 1.81479,
    "ensemble_error": 0.003,
    "grid_error": 0.004,
} | {
    f"{start}_{name}": math.nan
    for start in ("beside", "condition")
    for name in ("value", "ensemble_error", "grid_error")
}


def cells(*verdicts, widths=(1000.0, 2000.0, 4000.0, 8000.0), lattices=(2.0, 2.0, 4.0, 4.0)):
    """Admitted candidates of the claim `test` with given verdicts."""
    rows = zip(verdicts, widths, lattices, strict=True)
    table = [
        {"candidate": f"c{number}", "claim": "test", "verdict": verdict, "admitted": True}
        | {"width": width, "thickness": 1000.0, "lattice_constant": lattice}
        for number, (verdict, width, lattice) in enumerate(rows, start=1)
    ]
    return pd.DataFrame(table)


def test_the_numbers_of_the_row_are_put_into_a_cause():
    cause = Cause("estimator", "It is {value} ({value:%}), known to {error}: {margin} errors\nfrom the edge.")
    assert cause_text(cause, ROW, {}) == "Estimator: It is 1.8148 (181 %), known to 0.0050: 3.2 errors from the edge."
    assert cause_text(cause, ROW | {"verdict": REPRODUCED}, {}) == ""


def test_a_number_that_the_row_does_not_have_is_not_known():
    assert cause_text(Cause("physics", "{beside_value}, {cells_right}"), ROW, {}) == "Physics: not known, not known"


def test_a_number_of_the_data_is_put_into_a_cause():
    numbers = {"end": {"reduce": "largest"}, "coarse": {"study": "rough_line_many", "quantity": "kappa"}}
    settings = claim(cause={"kind": "physics", "numbers": numbers, "text": "From {value} to {end} ({coarse:%})."})
    assert Claim("test", settings).studies == ["rough_line", "rough_line_many"]
    cause = Cause(**settings["cause"])
    assert cause.numbers["end"]["quantity"] == settings["quantity"]
    data = {"rough_line": made_up(1.5, tilt=0.5), "rough_line_many": made_up(0.5)}
    assert cause_numbers(cause, Studies(data)) == pytest.approx({"end": 2.0, "coarse": 0.5})
    row = ROW | {"value": 1.5, "ensemble_error": 0.01, "grid_error": 0.0}
    assert cause_text(cause, row, {}, cause_numbers(cause, Studies(data))) == "Physics: From 1.500 to 2 (50 %)."


@pytest.mark.parametrize(
    ("number", "texts"),
    [
        (0.9965, ("0.997", "100 %")),
        (1.7002, ("1.70", "170 %")),
        (24.0, ("24", "2400 %")),
        (1118.4, ("1118", "111840 %")),
    ],
)
def test_a_number_of_the_data_has_three_digits_and_two_in_percent(number, texts):
    written = [
        cause_text(Cause("physics", text, numbers={"it": {}}), ROW, {}, {"it": number}) for text in ("{it}", "{it:%}")
    ]
    assert written == [f"Physics: {text}" for text in texts]


def test_a_number_that_no_state_gives_is_not_known():
    assert cause_text(Cause("physics", "{it}", numbers={"it": {}}), ROW, {}, {"it": math.nan}) == "Physics: not known"


def test_a_number_with_another_reduction_keeps_no_dimension_of_the_claim():
    spread = {"reduce": "spread", "along": "hurst_exponent", "quantity": "kappa_r"}
    settings = claim(**spread, cause={"kind": "physics", "numbers": {"it": {"reduce": "mean"}}, "text": "{it}"})
    assert settings["cause"]["numbers"]["it"]["along"] is None


@pytest.mark.parametrize(
    ("cause", "key", "allowed"),
    [
        ({"text": "It is.", "numbers": {"end": {"reduce": "largest"}}}, "numbers.end", "used in `text`"),
        ({"text": "It is {end}.", "numbers": {"end": {}}}, "numbers.end", "at least one of study"),
        ({"text": "It is {end}.", "numbers": {"end": {"expect": 2}}}, "numbers.end.expect", "quantity"),
        ({"text": "It is {end}.", "numbers": {"end": {"quantity": "kapa"}}}, "numbers.end.quantity", "kappa_r"),
        ({"text": "It is {end:.3f}.", "numbers": {"end": {"reduce": "largest"}}}, "text", "%"),
        ({"text": "It is {valu}."}, "text", "ensemble_error"),
        ({"text": "It is {boundary}."}, "text", "cells_holding"),
        ({"text": "It is {value:.3f}."}, "text", "%"),
        ({"text": "It is {margin:%} {side:%}.", "cell": {"width": 1}}, "text", "%"),
        ({"text": "It is wide.", "cell": {"depth": 1}}, "cell.depth", "width"),
    ],
)
def test_an_unknown_number_in_a_cause_is_refused_with_what_is_allowed(cause, key, allowed):
    with pytest.raises(InputError) as caught:
        claim(cause={"kind": "physics"} | cause)
    assert caught.value.key == f"claims.test.cause.{key}"
    assert "ch3.yaml" in str(caught.value)
    assert allowed in str(caught.value)


def test_a_boundary_separates_the_cells_in_which_a_statement_holds():
    rule = separate_cells(cells(NOT_REPRODUCED, NOT_REPRODUCED, REPRODUCED, REPRODUCED), {"width": 1})
    assert rule == CellRule(pytest.approx(math.sqrt(2000 * 4000)), "above", 4)
    lattice = separate_cells(cells(REPRODUCED, REPRODUCED, NOT_REPRODUCED, REPRODUCED), {"lattice_constant": 1})
    assert (lattice.side, lattice.right) == ("below", 3)
    assert separate_cells(cells(*[REPRODUCED] * 4), {"width": 1}) is None


def test_cells_that_are_not_decided_or_not_admitted_do_not_count():
    table = cells(REPRODUCED, NOT_DECIDABLE, NOT_REPRODUCED, NOT_REPRODUCED).assign(admitted=[True, True, True, False])
    texts = cell_texts(table, "test", {"width": 1, "lattice_constant": -2})
    assert texts["cells_right"] == "all 2 cells that are decided"
    assert (texts["cells_holding"], texts["cells_failing"], texts["cells_undecided"]) == ("1", "1", "1")
    assert "boundary" not in cell_texts(table, "test", None)
    assert len(admitted_cells(table.assign(candidate="default"), "test")) == 0


def repeated_numbers(cause, row, edges=()):
    """Numbers of two digits and more in a cause that are the row's number or one of its errors, also in percent.

    Numbers of the statement and edges of its band may stand in a cause.
    """
    texts = re.sub(r"\{.*?\}", "", cause.text)
    known = {*re.findall(r"[\d.]*\d", row.statement), *(f"{edge:g}" for edge in edges)}
    found = []
    for number, percent in NUMBER.findall(texts):
        decimals, digits = len(number.partition(".")[2]), len(number.replace(".", "").lstrip("0"))
        sizes = [abs(row[name]) * (100 if percent else 1) for name in FIRST_ROW]
        is_repeated = any(math.isfinite(size) and round(size, decimals) == float(number) for size in sizes)
        if digits > 1 and is_repeated and number not in known:
            found.append(number)
    return found


@pytest.mark.parametrize("name", CAUSES)
def test_a_cause_repeats_no_number_of_its_row_by_hand(name):
    assert "±" not in CAUSES[name].text, "an error in a cause is written {error}"
    settings = SETTINGS[name]
    edges = () if settings["reduce"] in ORDERS else band(settings)
    assert repeated_numbers(CAUSES[name], SHIPPED.loc[name], edges) == [], "write {value} or another name in braces"


def test_the_rule_on_repeated_numbers_finds_them():
    row = pd.Series(ROW | {"statement": "κ_r is 1.88."})
    text = "It is 1.815, or 181 %, not 1.88 or 1.8; {value} and 0.0030 are known."
    found = repeated_numbers(Cause("physics", text), row, edges=(1.8,))
    assert found == ["1.815", "181", "0.0030"]


def test_no_statement_of_the_shipped_table_that_fails_lacks_a_cause():
    candidates = pd.read_csv(FILE, comment="#")
    texts = []
    for row in SHIPPED.to_dict("records"):
        cause = CAUSES.get(row["claim"])
        numbers = cell_texts(candidates, row["claim"], cause.cell) if cause else {}
        own = dict.fromkeys(cause.numbers, 1.0) if cause else {}
        texts.append(cause_text(cause, row, numbers, own))
    assert claims_without_cause(SHIPPED.assign(cause=texts)) == []
    assert [text for text in texts if "not known" in text or "{" in text] == []


@pytest.mark.parametrize("name", [name for name, cause in CAUSES.items() if cause.cell])
def test_what_separates_the_cells_is_right_in_most_of_them(name):
    assert SHIPPED.verdict[name] == DEPENDS
    table = admitted_cells(pd.read_csv(FILE, comment="#"), name)
    decided = table[table.verdict != NOT_DECIDABLE]
    rule = separate_cells(decided, CAUSES[name].cell)
    majority = max((decided.verdict == REPRODUCED).sum(), (decided.verdict == NOT_REPRODUCED).sum())
    assert rule.right > majority or majority > 0.9 * len(decided)
    assert rule.right >= 0.75 * len(decided)
