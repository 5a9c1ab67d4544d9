"""What would decide a statement: the number of members that the errors ask for, or a smaller error of the grid."""

from __future__ import annotations

import math

import pytest

from contactsim.analysis.claims import judge_claims
from contactsim.analysis.deciding import deciding_text, members_needed
from contactsim.analysis.uncertainty import MIN_MARGIN
from support.claims import claim, made_up


def row(distance, ensemble_error, grid_error, members=10, seconds=3600.0):
    return {
        "margin": distance / math.hypot(ensemble_error, grid_error),
        "ensemble_error": ensemble_error,
        "grid_error": grid_error,
        "members": members,
        "seconds": seconds,
    }


@pytest.mark.parametrize("grid_error", [0.0, 0.3, 0.49])
def test_with_the_members_that_are_needed_the_margin_suffices_and_with_one_less_it_does_not(grid_error):
    needed = members_needed(row(1.0, 1.0, grid_error))
    for members, decided in ((needed, True), (needed - 1, False)):
        error = math.hypot(math.sqrt(10 / members), grid_error)
        assert (1.0 / error >= MIN_MARGIN) == decided


def test_the_cost_is_that_of_the_members_that_are_missing():
    told = deciding_text(row(1.0, 1.0, 0.0))
    assert told == "40 members in place of 10, 3 hours of one core more, if the number stays"


@pytest.mark.parametrize(("ensemble_error", "grid_error"), [(0.1, 0.6), (0.0, 0.6), (0.1, 0.5)])
def test_no_number_of_members_makes_up_for_the_error_of_the_grid(ensemble_error, grid_error):
    assert math.isinf(members_needed(row(1.0, ensemble_error, grid_error)))
    told = deciding_text(row(1.0, ensemble_error, grid_error))
    assert told == "an error of grid and increments below 0.5; more members alone do not"
    told = deciding_text(row(0.001, ensemble_error, grid_error))
    assert told.startswith("an error of grid and increments below 0.0005;")


def test_a_line_through_few_onsets_wants_more_of_them():
    told = deciding_text(row(1.0, 0.0, 0.8) | {"decided_over": "approaches"})
    assert told == "onsets at more approaches, until leaving out one of them changes the number by less than 0.5"


def test_nothing_is_told_where_an_error_is_not_known():
    assert deciding_text(row(1.0, float("nan"), 0.1)) == ""


def test_a_claim_tells_with_which_data_it_was_judged():
    judged = judge_claims({"one": claim()}, {"rough_line": made_up(2.0, grid=0.01)}).iloc[0]
    assert judged.deciding_study == "rough_line"
    assert judged.data == "`rough_line`: 4 members of 262144 points, 3 loads"
    both = {"rough_line": made_up(), "rough_line_many": made_up(members=2, points=65536)}
    ratio = claim(relative_to="rough_line_many", select={"reduced_pressure": [0.001, 0.001]})
    text = "`rough_line`: 4 members of 262144 points, 1 load; over `rough_line_many`: 2 members of 65536 points, 1 load"
    assert judge_claims({"one": ratio}, both).iloc[0]["data"] == text
    assert judged.members == made_up(2.0, grid=0.01).sizes.get("member", 1)
