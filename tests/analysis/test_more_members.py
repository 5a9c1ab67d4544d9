"""Members solved on a coarser grid only: their mean, its error, what stays unknown, and where they may come from."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

from contactsim import dataset
from contactsim.analysis.claim_data import data_text
from contactsim.analysis.claims import judge_cases
from contactsim.analysis.comparison import Comparison
from contactsim.analysis.more_members import with_more_members
from contactsim.analysis.uncertainty import estimate
from contactsim.errors import InputError
from contactsim.status import Status
from support.claims import claim, made_up

NAMES = ("rough_line", "rough_line_many")
MORE = {"more_members": ["rough_line_many"]}


def of_study(data, name="rough_line", surfaces="rough_line", **changes):
    """A made-up dataset as that of a study with the surfaces of another."""
    own = {"name": name, "same_surfaces_as": surfaces, "coarse_grid": {"members": 3}}
    return data.assign_attrs(settings=json.dumps(dataset.settings_of(data) | own | changes))


def pair(seed=0, few=4, many=40, scatter=0.1, change=0.2, change_scatter=0.02):
    """κ of some members on a fine grid and of more on a coarse one, all random."""
    random = np.random.default_rng(seed)
    coarse = made_up(members=many)
    coarse = coarse.assign(kappa=coarse.kappa + scatter * random.standard_normal((1, many, 1)))
    fine = coarse.isel(member=slice(few))
    fine = fine.assign(kappa=fine.kappa + change + change_scatter * random.standard_normal((1, few, 1)))
    return of_study(fine), of_study(coarse, "rough_line_many")


def number(data, **changes):
    """The number of a claim about one dataset."""
    return estimate(Comparison(claim(**changes), [data]))


def test_the_mean_is_that_of_all_on_the_coarse_grid_plus_the_mean_change_to_the_fine_one():
    fine, coarse = pair()
    change = fine.kappa - coarse.kappa.sel(member=fine.member)
    expected = coarse.kappa.mean("member") + change.mean("member")
    result = with_more_members(fine, [coarse])
    assert result.sizes["member"] == 40
    np.testing.assert_allclose(result.kappa.mean("member"), expected, rtol=1e-13)


def test_the_error_is_that_of_all_members_with_that_of_the_change():
    fine, coarse = pair(scatter=0.1, change_scatter=0.0)
    alone, joined = number(fine).ensemble_error, number(with_more_members(fine, [coarse])).ensemble_error
    assert joined == pytest.approx(number(coarse).ensemble_error, rel=1e-9)
    assert joined < alone


@pytest.mark.parametrize(("scatter", "change_scatter"), [(0.1, 0.02), (0.1, 0.1), (0.01, 0.1)])
def test_the_error_holds_in_most_ensembles_whatever_scatters_most(scatter, change_scatter):
    results = [
        number(with_more_members(fine, [coarse]))
        for fine, coarse in (pair(seed, scatter=scatter, change_scatter=change_scatter) for seed in range(80))
    ]
    held = [abs(result.value - 2.2) < 2 * result.ensemble_error for result in results]
    assert np.mean(held) >= 0.9
    scatter_of_values = np.std([result.value for result in results])
    assert np.median([result.ensemble_error for result in results]) < 2.5 * scatter_of_values


def test_grids_follow_each_other_from_the_finest_to_the_coarsest():
    fine, coarse = pair(few=4, many=40)
    finest = of_study(fine.isel(member=slice(3)), "rough_line_fine")
    finest = finest.assign(kappa=finest.kappa + 0.05)
    chained = with_more_members(finest, [fine, coarse])
    assert chained.sizes["member"] == 40
    level = with_more_members(fine, [coarse]).kappa.mean() + 0.05
    assert float(chained.kappa.mean()) == pytest.approx(float(level), rel=1e-12)


def test_only_loads_and_variants_of_both_are_left():
    fine, coarse = pair()
    coarse = coarse.isel(reduced_pressure=[0, 2], hurst_exponent=[1])
    assert dict(with_more_members(fine, [coarse]).sizes) == {"hurst_exponent": 1, "reduced_pressure": 2, "member": 40}


def test_a_state_that_was_not_solved_on_either_grid_stays_unknown():
    for grid, member in (("fine", 1), ("coarse", 1), ("coarse", 20)):
        fine, coarse = pair()
        data = fine if grid == "fine" else coarse
        data.status[0, member, 2] = Status.MAX_ITERATIONS.value[0]
        joined = with_more_members(fine, [coarse])
        means = joined.kappa.mean("member", skipna=False)
        assert np.isnan(means[0, 2])
        assert np.isfinite(means).sum() == means.size - 1
        assert np.isnan(number(joined).value)


def test_other_surfaces_and_no_more_members_leave_a_study_as_it_is():
    fine, coarse = pair()
    xr.testing.assert_identical(with_more_members(fine, [of_study(coarse, "rough_surface", "rough_surface")]), fine)
    xr.testing.assert_identical(with_more_members(fine, [of_study(fine, "rough_line_many")]), fine)


def test_a_claim_takes_the_members_and_says_so():
    fine, coarse = pair()
    settings = claim(**MORE)
    row = judge_cases(settings, dict(zip(NAMES, (fine, coarse), strict=True)))
    assert row["members"] == 40
    assert row["data"].endswith("and 36 members carried from fewer points")
    assert "carried" not in data_text(claim(), [fine])


@pytest.mark.parametrize("name", ["rough_surface", "rough_line", "nothing", "smooth_line"])
def test_members_come_from_a_study_that_has_them(name):
    with pytest.raises(InputError, match="more_members") as error:
        claim(more_members=[name])
    assert "one of rough_line_many" in str(error.value)
