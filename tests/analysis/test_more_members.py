"""Members solved on a coarse grid only: their mean, its error, what stays unknown, and where they may come from."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from contactsim import dataset
from contactsim.analysis.claim_data import data_text
from contactsim.analysis.claims import judge_cases
from contactsim.analysis.comparison import Comparison
from contactsim.analysis.deciding import Effort, deciding_text
from contactsim.analysis.more_members import Studies, with_more_members
from contactsim.analysis.uncertainty import estimate, student_factor
from contactsim.analysis.unknown_places import unknown_places
from contactsim.errors import InputError
from contactsim.status import Status
from contactsim.study.claim_plan import read_claim
from support.claims import BANDLESS, STUDIES, VALUE, claim, made_up

NAMES = ("rough_line", "rough_line_many")
MORE = {"more_members": ["rough_line_many"]}
RANGE = {"reduce": "spread", "along": "reduced_pressure", **BANDLESS, "at_most": 0.1}


def of_study(data, name="rough_line", surfaces="rough_line"):
    """A made-up dataset as that of a study with the surfaces of another."""
    own = {"name": name, "same_surfaces_as": surfaces, "coarse_grid": {"members": 3}}
    return data.assign_attrs(settings=json.dumps(dataset.settings_of(data) | own))


def noisy(data, scatter, random):
    """A dataset with noise in κ that each variant, member and load has of its own."""
    return data.assign(kappa=data.kappa + scatter * random.standard_normal(data.kappa.shape))


def pair(seed=0, few=4, many=40, scatter=0.1, change_scatter=0.02):
    """κ about 2 of many members on a coarse grid, and about 2.2 of a few of them on a fine one."""
    random = np.random.default_rng(seed)
    coarse = noisy(made_up(members=many), scatter, random)
    fine = coarse.isel(member=slice(few))
    fine = noisy(fine.assign(kappa=fine.kappa + 0.2), change_scatter, random)
    return of_study(fine), of_study(coarse, "rough_line_many")


def number(data, **changes):
    """The number of a claim about one dataset."""
    return estimate(Comparison(claim(**changes), [data]))


def test_the_mean_is_that_of_all_on_the_coarse_grid_plus_the_mean_change_to_the_fine_one():
    fine, coarse = pair()
    change = fine.kappa - coarse.kappa.sel(member=fine.member)
    result = with_more_members(fine, [coarse])
    assert result.sizes["member"] == 40
    np.testing.assert_allclose(result.kappa.mean("member"), (coarse.kappa.mean("member") + change.mean("member")))


def test_three_grids_follow_each_other_from_the_finest_to_the_coarsest():
    fine, coarse = pair(few=10)
    finest = noisy(of_study(fine.isel(member=slice(3)), "rough_line_fine"), 0.05, np.random.default_rng(1))
    chained = with_more_members(finest, [fine, coarse])
    changes = [
        (upper.kappa - lower.kappa.sel(member=upper.member)).mean("member")
        for upper, lower in ((finest, fine), (fine, coarse))
    ]
    np.testing.assert_allclose(chained.kappa.mean("member"), coarse.kappa.mean("member") + sum(changes))


@pytest.mark.parametrize("few", [2, 3, 10])
def test_the_error_is_that_of_few_changes_where_they_alone_scatter(few):
    fine, coarse = pair(few=few, scatter=0.0, change_scatter=0.1)
    weights = xr.DataArray([0.25, 0.5, 0.25], dims="reduced_pressure")  # of a mean over log p*
    changes = (fine.kappa * weights).sum("reduced_pressure").mean("hurst_exponent").values
    expected = student_factor(few) * student_factor(20) * changes.std(ddof=1) / np.sqrt(few)
    # twenty blocks of two members: the mean of the two, of which one has no change of its own
    blocks = np.sqrt(20 / 19 * 39 / 40)
    assert number(with_more_members(fine, [coarse])).ensemble_error == pytest.approx(expected * blocks, rel=1e-6)


def test_the_error_is_that_of_all_members_where_all_change_alike():
    fine, coarse = pair(change_scatter=0.0)
    assert number(with_more_members(fine, [coarse])).ensemble_error == pytest.approx(number(coarse).ensemble_error)


@pytest.mark.parametrize("few", [3, 10])
def test_a_range_of_what_does_not_vary_is_zero_on_average(few):
    ensembles = (pair(seed, few=few, scatter=0.02, change_scatter=0.02) for seed in range(40))
    ranges = [
        Comparison(claim(**RANGE), [joined]).unbiased_number([joined])
        for joined in (with_more_members(fine, [coarse]) for fine, coarse in ensembles)
    ]
    assert abs(np.mean(ranges)) < 3 * np.std(ranges) / np.sqrt(len(ranges))


def test_only_loads_and_variants_of_both_are_left_and_no_means_of_few():
    fine, coarse = pair()
    fine = fine.assign(kappa_mean=fine.kappa.mean("member"))
    joined = with_more_members(fine, [coarse.isel(reduced_pressure=[0, 2], hurst_exponent=[1])])
    assert dict(joined.sizes) == {"hurst_exponent": 1, "reduced_pressure": 2, "member": 40}
    assert "kappa_mean" not in joined


@pytest.mark.parametrize(("grid", "member"), [("fine", 1), ("coarse", 1), ("coarse", 20)])
def test_a_state_that_was_not_solved_on_either_grid_stays_unknown_and_is_named(grid, member):
    fine, coarse = pair()
    data = fine if grid == "fine" else coarse
    data.status[0, member, 2] = Status.MAX_ITERATIONS.value[0]
    joined = with_more_members(fine, [coarse])
    means = joined.kappa.mean("member", skipna=False)
    assert np.isnan(means[0, 2])
    assert np.isfinite(means).sum() == means.size - 1
    comparison = Comparison(claim(), [joined])
    assert np.isnan(estimate(comparison).value)
    assert unknown_places(comparison) == f"κ at H = 0.2, member = {member}, p* = 0.1"


def test_other_surfaces_leave_a_study_as_it_is():
    fine, coarse = pair()
    xr.testing.assert_identical(with_more_members(fine, [of_study(coarse, "rough_surface", "rough_surface")]), fine)


def test_a_claim_takes_the_members_and_says_so():
    fine, coarse = pair()
    row = judge_cases(claim(**MORE), Studies(dict(zip(NAMES, (fine, coarse), strict=True))))
    assert row["members"] == 40
    assert row["data"] == "`rough_line`: 4 members of 262144 points and 40 of 262144 (`rough_line_many`), 3 loads"
    assert data_text(claim(), [fine]) == "`rough_line`: 4 members of 262144 points, 3 loads"
    assert "times the members on both grids" in deciding_text(row | {"margin": 1.0}, Effort(3600.0))


def changed(name, **settings):
    """The studies of tests, one of them with other settings."""
    return STUDIES | {name: replace(STUDIES[name], settings=STUDIES[name].settings | settings)}


@pytest.mark.parametrize(
    ("changes", "studies"),
    [
        ({"more_members": ["rough_surface"]}, STUDIES),
        ({"more_members": ["rough_line"]}, STUDIES),
        ({"more_members": ["nothing"]}, STUDIES),
        (MORE, changed("rough_line_many", members=3)),
        (MORE, changed("rough_line_many", points=2**20)),
        (MORE, changed("rough_line_many", effects=["cohesive_zone"])),
        (MORE, changed("rough_line_many", load=STUDIES["rough_line"].settings["load"] | {"values": [0.2]})),
        (MORE, changed("rough_line", members=1)),
    ],
)
def test_members_come_from_a_study_of_the_same_surfaces_with_more_of_them_on_no_more_points(changes, studies):
    with pytest.raises(InputError, match="more_members") as error:
        read_claim("test", VALUE | changes, "ch3.yaml", studies)
    assert "more members on no more points" in str(error.value)


@pytest.mark.parametrize("quantity", ["kappa_fit_logarithm", "solution_seconds", "relative_contact_area_bar_share"])
def test_what_is_no_function_of_means_cannot_be_transferred(quantity):
    with pytest.raises(InputError, match=quantity):
        claim(quantity=quantity, **MORE)


def test_another_study_in_a_case_has_no_members_of_the_first():
    settings = claim(case="lines", cases={"surfaces": {"study": "rough_surface"}}, **MORE)
    assert settings["cases"]["surfaces"]["more_members"] is None
