"""A statement that depends on what the text leaves open has a verdict of its own; failures have causes."""

from __future__ import annotations

import pandas as pd
import pytest

from contactsim.analysis.admissible import (
    BANDS,
    CANDIDATE_COLUMNS,
    DEFAULT,
    Choice,
    candidate_choices,
    choice_entries,
    choices_table,
    read_candidates,
)
from contactsim.analysis.candidate_shares import HoldingShare
from contactsim.analysis.causes import UNKNOWN, claims_without_cause
from contactsim.analysis.claims import judge_claims
from contactsim.analysis.verdict import CONDITION, DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from contactsim.analysis.wording import candidates_text, choices_text, readings_text
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


def verdicts_in_cells(*verdicts):
    """Drawn candidates, each admitted, with the verdict on the claim `test`; the first lacks the signs."""
    rows = [
        {"candidate": f"c{number}", "claim": "test", "value": 2.0, "margin": 9.0, "admitted": True}
        | dict.fromkeys(BANDS, verdict)
        | {"admitted_by_signs": number > 1, "apart": number == 2}
        for number, verdict in enumerate(verdicts, start=1)
    ]
    return pd.DataFrame(rows, columns=list(CANDIDATE_COLUMNS))


def test_admitted_candidates_are_readings_of_their_claim(tmp_path):
    table = verdicts_in_cells(REPRODUCED, NOT_REPRODUCED)
    table.to_csv(tmp_path / "candidates.csv", index=False)
    read = read_candidates(tmp_path / "candidates.csv")
    assert [choice.choice for choice in candidate_choices(read, "test")] == ["c1", "c2"]
    assert candidate_choices(read, "other") == []
    assert candidate_choices(read.assign(admitted=[False, True]), "test")[0].choice == "c2"
    assert read_candidates(None).empty


def test_a_statement_that_fails_in_some_admitted_cells_depends_on_what_is_open_with_both_shares_beside_it():
    table = verdicts_in_cells(REPRODUCED, NOT_REPRODUCED, NOT_REPRODUCED, NOT_DECIDABLE)
    judged = judge_claims({"test": claim()}, {"rough_line": DATA}, table).iloc[0]
    assert (judged.verdict, judged.default_verdict) == (DEPENDS, REPRODUCED)
    assert (judged.admitted_decided, judged.admitted_by_signs_decided) == (3, 2)
    assert (judged.admitted_share, judged.admitted_by_signs_share) == (pytest.approx(1 / 3), 0.0)
    assert judged.choices == ""
    words = "holds in 1 of the 3 admitted cells, and in none of the 2 that also have the signs of the text, "
    words += "and not in the one that is apart from its replicas"
    assert choices_text(judged) == f"{words}; as judged: reproduced"


@pytest.mark.parametrize(
    ("held", "count", "words"),
    [
        (36, 38, "holds in 36 of the 38 admitted cells (95% ± 4%)"),
        (38, 38, "holds in all of the 38 admitted cells (100% ± 3%)"),
        (0, 4, "holds in none of the 4 admitted cells"),
        (0, 1, "holds not in the one admitted cell"),
    ],
)
def test_cells_are_counted_and_a_share_of_few_is_not_given(held, count, words):
    share = HoldingShare(count, held)
    numbers = {"decided": count, "share": share.share, "error": share.error}
    assert candidates_text({f"admitted_{name}": number for name, number in numbers.items()}) == words


@pytest.mark.parametrize(
    ("count", "share", "words"),
    [
        (2, 0.0, "holds with none of the 2 readings that are decided"),
        (1, 1.0, "holds with the one reading that is decided"),
        (0, float("nan"), "not decidable with any reading"),
    ],
)
def test_readings_are_counted(count, share, words):
    assert readings_text({"choices": "[]", "choices_decided": count, "choices_share": share}) == words


def test_a_statement_that_holds_in_all_admitted_cells_keeps_its_verdict():
    judged = judge_claims({"test": claim()}, {"rough_line": DATA}, verdicts_in_cells(REPRODUCED, REPRODUCED)).iloc[0]
    assert judged.verdict == REPRODUCED
    without = judge_claims({"test": claim()}, {"rough_line": DATA}).iloc[0]
    assert choices_text(without) == ""


def test_a_claim_asks_for_the_studies_of_its_alternatives():
    section = VALUE | {"admissible": {"grid": {"coarse": {"study": "rough_line_many"}}}}
    assert read_claim("test", section, "ch3.yaml", STUDIES).studies == ["rough_line", "rough_line_many"]


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"admissible": {"weights": {}}}, "admissible.weights"),
        ({"admissible": {"weights": {"none": {}}}}, "admissible.weights.none"),
        ({"admissible": {"weights": {"x": {"neutral": 3.0}}}}, "admissible.weights.x.neutral"),
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


def test_a_reading_may_be_an_order_which_has_no_band():
    trend = {"what is meant": {"a trend": {"reduce": "falling_steps", "along": "reduced_pressure"}}}
    settings = claim(admissible=trend)
    (reading,) = settings["admissible"].values()
    assert (reading["reduce"], reading["expect"], reading["tolerance"]) == ("falling_steps", None, None)
    falls = judge_claims({"test": settings}, {"rough_line": made_up(3.0, tilt=-0.1)}).iloc[0]
    assert (falls.default_verdict, falls.verdict) == (NOT_REPRODUCED, DEPENDS)
