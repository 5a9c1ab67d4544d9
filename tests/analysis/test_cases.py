"""A statement about several cases holds if it holds in each of them, and counts once."""

from __future__ import annotations

import pytest

from contactsim.analysis.claims import judge_claims
from contactsim.analysis.verdict import DEPENDS, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from contactsim.errors import InputError
from contactsim.study.claim_plan import Claim, read_claim
from support.claims import STUDIES, VALUE, claim, made_up

CASES = {"coarse": {"study": "rough_line_many"}}


def row(first, second, **changes):
    """The row of a claim on two studies, whose κ have given levels and grid errors."""
    data = {"rough_line": made_up(first[0], grid=first[1]), "rough_line_many": made_up(second[0], grid=second[1])}
    return judge_claims({"test": claim(case="fine", cases=CASES, **changes)}, data).iloc[0]


@pytest.mark.parametrize(
    ("first", "second", "verdict", "value"),
    [
        ((2.0, 0.01), (2.05, 0.01), REPRODUCED, 2.05),  # the smaller margin
        ((2.0, 0.01), (2.3, 0.01), NOT_REPRODUCED, 2.3),
        ((2.3, 0.01), (2.0, 0.01), NOT_REPRODUCED, 2.3),
        ((2.0, 0.01), (2.05, 0.04), NOT_DECIDABLE, 2.05),
        ((2.3, 0.01), (2.05, 0.04), NOT_REPRODUCED, 2.3),
    ],
)
def test_the_worst_case_counts(first, second, verdict, value):
    judged = row(first, second)
    assert judged.verdict == verdict
    assert judged.value == pytest.approx(value)
    assert judged.cases.count(";") == 1


def test_each_width_of_the_bands_has_its_own_worst_case():
    judged = row((2.04, 0.001), (2.0, 0.01), tolerance=0.05)
    assert (judged.verdict, judged.verdict_half, judged.verdict_double) == (REPRODUCED, NOT_REPRODUCED, REPRODUCED)


def test_a_reading_has_the_cases_of_the_claim_or_its_own():
    data = {"rough_line": made_up(2.0, grid=0.001), "rough_line_many": made_up(2.3, grid=0.001)}
    heavy = {"select": {"reduced_pressure": [0.01, 0.1]}}
    readings = {"loads": {"heavy": heavy, "light": {"cases": {"light": {"select": {"reduced_pressure": [0, 0.002]}}}}}}
    judged = judge_claims({"test": claim(case="fine", cases=CASES, admissible=readings)}, data).iloc[0]
    assert (judged.verdict, judged.default_verdict, judged.choices_share) == (DEPENDS, NOT_REPRODUCED, 1 / 3)


def test_the_studies_of_all_cases_belong_to_the_claim():
    settings = claim(case="fine", cases=CASES)
    assert Claim("test", settings).studies == ["rough_line", "rough_line_many"]


@pytest.mark.parametrize(("case", "key"), [({}, "coarse"), ({"study": "none"}, "study"), ({"band": 1}, "band")])
def test_a_case_that_changes_nothing_or_names_nothing_is_refused(case, key):
    with pytest.raises(InputError, match=key):
        read_claim("test", VALUE | {"case": "fine", "cases": {"coarse": case}}, "ch3.yaml", STUDIES)


def test_the_claim_s_own_case_has_a_name():
    with pytest.raises(InputError, match=r"claims\.test\.case: got None; allowed: a name"):
        read_claim("test", VALUE | {"cases": CASES}, "ch3.yaml", STUDIES)
    with pytest.raises(InputError, match=r"claims\.test\.case: got 'coarse'"):
        read_claim("test", VALUE | {"case": "coarse", "cases": CASES}, "ch3.yaml", STUDIES)


def test_the_row_has_the_band_of_the_case_that_decides():
    data = {"rough_line": made_up(2.0, grid=0.01), "rough_line_many": made_up(2.3, grid=0.01)}
    settings = claim(case="fine", cases={"coarse": {"study": "rough_line_many", "reduce": "largest", "expect": 2.2}})
    judged = judge_claims({"test": settings}, data).iloc[0]
    assert (judged.deciding_case, judged.expected) == ("coarse", "2.2 ± 0.1")
    assert judged.measure == "largest of kappa, worst of 2 cases"
    assert judged.cases.startswith("fine: reproduced (2); coarse: ")
