"""What would decide a statement: the number of members that the errors ask for, or a smaller error of the grid."""

from __future__ import annotations

import math

import pandas as pd
import pytest

from contactsim.analysis.claims import judge_claims
from contactsim.analysis.deciding import Effort, deciding_text, members_needed
from contactsim.analysis.uncertainty import MIN_MARGIN
from support.claims import claim, made_up

HOUR = Effort(3600.0)


def row(distance, ensemble_error, grid_error, members=10):
    return {
        "margin": distance / math.hypot(ensemble_error, grid_error),
        "ensemble_error": ensemble_error,
        "grid_error": grid_error,
        "members": members,
    }


@pytest.mark.parametrize("grid_error", [0.0, 0.3, 0.49])
def test_with_the_members_that_are_needed_the_margin_suffices_and_with_one_less_it_does_not(grid_error):
    needed = members_needed(row(1.0, 1.0, grid_error))
    for members, decided in ((needed, True), (needed - 1, False)):
        error = math.hypot(math.sqrt(10 / members), grid_error)
        assert (1.0 / error >= MIN_MARGIN) == decided


def test_the_cost_is_that_of_the_members_that_are_missing():
    told = deciding_text(row(1.0, 1.0, 0.0), HOUR)
    assert told == "40 members in place of 10, 3 h of one core more, if the number stays"
    told = deciding_text(row(1.0, 1.0, 0.0) | {"decided_over": "grids"}, HOUR)
    assert told == "4 times the members on both grids, 3 h of one core more, if the number stays"


@pytest.mark.parametrize(("ensemble_error", "grid_error"), [(0.1, 0.6), (0.0, 0.6), (0.1, 0.5)])
@pytest.mark.parametrize("over", ["", "grids"])
def test_no_number_of_members_makes_up_for_the_error_of_the_grid(ensemble_error, grid_error, over):
    assert math.isinf(members_needed(row(1.0, ensemble_error, grid_error)))
    told = deciding_text(row(1.0, ensemble_error, grid_error) | {"decided_over": over}, HOUR)
    assert told == "an error of grid and increments below 0.5; more members alone do not"


@pytest.mark.parametrize(
    ("ensemble_error", "cost"),
    [
        (0.1, "at first order the points doubled 2 times, 16 h of one core"),  # 1.2 to 0.3, and √0.24 is allowed
        (1.0, "at first order the points doubled 2 times, 8 times the members, 128 h of one core"),
    ],
)
def test_points_are_doubled_and_members_added_until_both_errors_fit(ensemble_error, cost):
    told = deciding_text(row(1.0, ensemble_error, 1.2), Effort(3600.0, doubling=4.0))
    assert told == f"an error of grid and increments below 0.5; more members alone do not ({cost})"


def test_the_effort_of_a_study_is_read_from_its_costs():
    columns = ["points", "slide_approach", "measures_error", "seconds"]
    runs = [(256, -1.0, False, 4.0), (256, 3.0, False, 6.0), (128, 3.0, True, 2.0), (256, 3.0, True, 9.0)]
    effort = Effort.of_costs(pd.DataFrame(runs, columns=columns))
    assert effort == Effort(10.0, doubling=2.5, approaches=2)  # another error is measured on the same grid
    alone = Effort.of_costs(pd.DataFrame(runs[:2], columns=columns).drop(columns="slide_approach"))
    assert (math.isnan(alone.doubling), alone.approaches) == (True, 1)


def test_a_line_through_few_onsets_wants_more_of_them():
    told = deciding_text(row(1.0, 0.0, 0.8) | {"decided_over": "approaches"}, Effort(90.0, approaches=9))
    assert told == "more approaches (10 s of one core each), until leaving out one changes the number by less than 0.5"


def test_nothing_is_told_where_an_error_is_not_known():
    assert deciding_text(row(1.0, float("nan"), 0.1), HOUR) == ""


def test_a_claim_tells_with_which_data_it_was_judged():
    judged = judge_claims({"one": claim()}, {"rough_line": made_up(2.0, grid=0.01)}).iloc[0]
    assert judged.deciding_study == "rough_line"
    assert judged.data == "`rough_line`: 4 members of 262144 points, 3 loads"
    both = {"rough_line": made_up(), "rough_line_many": made_up(members=2, points=65536)}
    ratio = claim(relative_to="rough_line_many", select={"reduced_pressure": [0.001, 0.001]})
    text = "`rough_line`: 4 members of 262144 points, 1 load; over `rough_line_many`: 2 members of 65536 points, 1 load"
    assert judge_claims({"one": ratio}, both).iloc[0]["data"] == text
    assert judged.members == made_up(2.0, grid=0.01).sizes.get("member", 1)
