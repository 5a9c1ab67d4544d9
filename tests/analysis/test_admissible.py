"""A statement that depends on what the text leaves open has a verdict of its own; failures have causes."""

from __future__ import annotations

import json

import pandas as pd
import pytest

from contactsim.analysis.admissible import (
    DEFAULT,
    Choice,
    candidate_choices,
    choice_entries,
    choices_table,
    read_candidates,
)
from contactsim.analysis.causes import UNKNOWN, claims_without_cause
from contactsim.analysis.claims import judge_claims
from contactsim.analysis.verdict import CONDITION, DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from contactsim.errors import InputError
from contactsim.publish.gallery import count_verdicts
from contactsim.study.claim_plan import read_claim
from support.claims import STUDIES, VALUE, claim, made_up, with_corrected

OTHER = {"weights": {"corrected": {"quantity": "kappa_corrected"}}}
DATA = with_corrected(made_up(2.05, grid=0.01), 2.3, change=0.01, subgrid=2.3)
CAUSE = {"kind": "estimator", "text": "Off by 0.3."}


def row(data=DATA, **changes):
    """The row of a claim on rough lines."""
    return judge_claims({"test": claim(**changes)}, {"rough_line": data}).iloc[0]


def test_a_statement_that_holds_with_one_reading_and_fails_with_another_depends_on_what_is_open():
    judged = row(admissible=OTHER)
    assert (judged.verdict, judged.default_verdict) == (DEPENDS, REPRODUCED)
    assert (judged.choices_decided, judged.choices_share) == (2, 0.5)
    table = choices_table(pd.DataFrame([judged]))
    assert table.choice.tolist() == [DEFAULT, "weights: corrected"]
    assert table.verdict.tolist() == [REPRODUCED, NOT_REPRODUCED]
    assert table.value.tolist() == pytest.approx([2.05, 2.3])
    assert count_verdicts(pd.DataFrame([judged]))[DEPENDS] == 1


def test_each_reading_is_judged_with_half_and_double_bands_too():
    judged = row(admissible=OTHER, tolerance=0.2)
    assert (judged.verdict, judged.verdict_half, judged.verdict_double) == (DEPENDS, DEPENDS, REPRODUCED)


def test_the_selection_of_a_reading_is_its_own():
    data = made_up(2.0, grid=0.001, tilt=0.3)
    narrow = {"loads": {"light": {"select": {"reduced_pressure": [0.0, 0.002]}}}}
    assert row(data).verdict == REPRODUCED
    assert row(data, admissible=narrow).verdict == DEPENDS


@pytest.mark.parametrize(
    ("default", "others", "verdict", "decided", "share"),
    [
        (REPRODUCED, [NOT_REPRODUCED], DEPENDS, 2, 0.5),
        (NOT_REPRODUCED, [REPRODUCED, REPRODUCED], DEPENDS, 3, 2 / 3),
        (CONDITION, [REPRODUCED], DEPENDS, 2, 0.5),
        (CONDITION, [NOT_REPRODUCED], CONDITION, 2, 0.0),
        (REPRODUCED, [REPRODUCED, NOT_DECIDABLE], REPRODUCED, 2, 1.0),
        (REPRODUCED, [NOT_DECIDABLE], REPRODUCED, 1, 1.0),
        (NOT_DECIDABLE, [REPRODUCED], NOT_DECIDABLE, 1, 1.0),
        (NOT_DECIDABLE, [REPRODUCED, NOT_REPRODUCED], DEPENDS, 2, 0.5),
    ],
)
def test_what_is_not_decidable_counts_neither_way(default, others, verdict, decided, share):
    base = dict.fromkeys(("verdict", "verdict_half", "verdict_double"), default)
    entries = choice_entries(base, [Choice(str(n), other) for n, other in enumerate(others)])
    assert (entries["verdict"], entries["choices_decided"]) == (verdict, decided)
    assert entries["choices_share"] == pytest.approx(share)


def test_admitted_candidates_are_readings(tmp_path):
    file = tmp_path / "candidates.csv"
    assert read_candidates(file).empty
    rows = [
        ("a", "test", REPRODUCED, 2.0, 9.0, True),
        ("b", "test", NOT_REPRODUCED, 2.4, 8.0, False),
        ("c", "other", NOT_REPRODUCED, 2.4, 8.0, True),
    ]
    pd.DataFrame(rows, columns=["candidate", "claim", "verdict", "value", "margin", "admitted"]).to_csv(file)
    assert [choice.choice for choice in candidate_choices(read_candidates(file), "test")] == ["a"]
    failing = read_candidates(file).assign(admitted=True)
    judged = judge_claims({"test": claim()}, {"rough_line": DATA}, failing).iloc[0]
    assert (judged.verdict, judged.choices_decided) == (DEPENDS, 3)
    assert [entry["choice"] for entry in json.loads(judged.choices)] == [DEFAULT, "a", "b"]


def test_a_claim_asks_for_the_studies_of_its_alternatives():
    section = VALUE | {"admissible": {"grid": {"coarse": {"study": "rough_line_many"}}}}
    assert read_claim("test", section, "ch3.yaml", STUDIES).studies == ["rough_line", "rough_line_many"]


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"admissible": {"weights": {}}}, "admissible.weights"),
        ({"admissible": {"weights": {"none": {}}}}, "admissible.weights.none"),
        ({"admissible": {"weights": {"x": {"at_most": 3.0}}}}, "admissible.weights.x.at_most"),
        ({"admissible": {"weights": {"x": {"quantity": "kapa"}}}}, "admissible.weights.x.quantity"),
        ({"cause": {"kind": "weather", "text": "Rain."}}, "cause.kind"),
        ({"cause": {"kind": "physics"}}, "cause.text"),
    ],
)
def test_a_bad_alternative_or_cause_is_refused(changes, key):
    with pytest.raises(InputError) as caught:
        claim(**changes)
    assert caught.value.key == f"claims.test.{key}"


@pytest.mark.parametrize(("key", "value"), [("admissible", OTHER), ("cause", CAUSE)])
def test_a_finding_has_neither(key, value):
    section = {name: entry for name, entry in VALUE.items() if name not in ("expect", "tolerance")}
    with pytest.raises(InputError, match=key):
        read_claim("test", section | {key: value}, "ch3.yaml", STUDIES, "findings")


def test_a_cause_stands_with_a_failure_only():
    failing = made_up(2.5, grid=0.01)
    assert row(cause=CAUSE).cause == ""
    assert row(failing, cause=CAUSE).cause == "Estimator: Off by 0.3."
    assert row(failing).cause == UNKNOWN
    rows = pd.DataFrame([row(), row(failing), row(failing, cause=CAUSE)]).assign(claim=["holds", "open", "explained"])
    assert claims_without_cause(rows) == ["open"]
