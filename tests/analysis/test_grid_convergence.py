"""Extrapolation to the limit: made sequences of known order give their limit, all others none."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.analysis.grid_convergence import extrapolate, is_doubled, jackknife
from contactsim.errors import InputError


def on_grids(*values, points=(1024, 2048, 4096), dims=("points",)):
    """Values along three grids, made up."""
    return xr.DataArray(np.asarray(values, float), {"points": list(points)}, dims=dims)


@pytest.mark.parametrize("order", [0.5, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("size", [3.0, -0.2])
def test_a_sequence_of_known_order_gives_its_limit(order, size):
    spacing = np.array([4.0, 2.0, 1.0])
    found = extrapolate(on_grids(*(1.75 + size * spacing**order)))
    assert float(found.order) == pytest.approx(order, rel=1e-12)
    assert float(found.limit) == pytest.approx(1.75, rel=1e-12)
    last = size * (1 - 2.0**order)
    assert float(found.spread) == pytest.approx(-size - last, abs=1e-12)  # what is left, against one more change


def test_at_first_order_the_limit_lies_one_change_further_and_has_no_error():
    found = extrapolate(on_grids(9.0, 5.0, 3.0))
    assert (float(found.limit), float(found.order), float(found.spread)) == (1.0, 1.0, 0.0)


@pytest.mark.parametrize(
    "values",
    [(1.0, 2.0, 1.5), (2.0, 1.0, 1.5), (1.0, 2.0, 3.0), (1.0, 2.0, 4.0), (1.0, 1.0, 2.0), (1.0, np.nan, 1.5)],
    ids=["turns down", "turns up", "as fast", "faster", "starts late", "not known"],
)
def test_changes_that_turn_or_do_not_shrink_have_no_limit(values):
    found = extrapolate(on_grids(*values))
    assert found.isnull().all().to_array().all()


def test_what_no_longer_changes_is_its_own_limit():
    found = extrapolate(on_grids(3.0, 2.0, 2.0))
    assert float(found.limit) == 2.0
    assert float(found.spread) == 0.0


@pytest.mark.parametrize("points", [(1024, 2048), (1024, 2048, 3072), (1024, 2048, 4096, 8192), (4096, 2048, 1024)])
def test_other_than_three_doubled_grids_are_refused(points):
    values = on_grids(*range(len(points)), points=points)
    assert not is_doubled(values.points)
    with pytest.raises(InputError, match="each twice as fine"):
        extrapolate(values)


def mean_of(values):
    return values.isel(points=0, drop=True).to_dataset(name="first")


def ensemble(values):
    return on_grids(*np.transpose(values), dims=("points", "member"))


def test_the_jackknife_of_a_mean_is_its_standard_error():
    draw = np.random.default_rng(1).random((7, 3))
    found = jackknife(mean_of, ensemble(draw))
    assert float(found["first"]) == pytest.approx(draw[:, 0].mean(), rel=1e-12)
    assert float(found["first_standard_error"]) == pytest.approx(draw[:, 0].std(ddof=1) / np.sqrt(7), rel=1e-12)


def test_errors_of_independent_ensembles_add_in_squares():
    one, two = np.random.default_rng(2).random((2, 5, 3))
    two = two[:3]

    def total(a, b):
        return mean_of(a) + mean_of(b)

    parts = [values[:, 0].std(ddof=1) / np.sqrt(len(values)) for values in (one, two)]
    found = jackknife(total, ensemble(one), ensemble(two))
    assert float(found["first_standard_error"]) == pytest.approx(np.hypot(*parts), rel=1e-12)


def test_one_member_has_a_limit_and_no_error():
    found = jackknife(extrapolate, ensemble([[9.0, 5.0, 3.0]]))
    assert float(found.limit) == 1.0
    assert found.limit_standard_error.isnull()


def test_a_limit_that_hangs_on_one_member_is_none():
    still, moving = [3.0, 3.0, 3.5], [30.0, 10.0, 5.0]
    alone = extrapolate(ensemble([still, moving]).mean("member"))
    assert float(alone.limit) > 0
    found = jackknife(extrapolate, ensemble([still, moving]))
    assert found.isnull().all().to_array().all()


def test_members_that_differ_by_a_constant_have_one_order_and_the_error_of_their_level():
    level = np.array([0.0, 1.0, 5.0, 6.0])
    found = jackknife(extrapolate, ensemble(level[:, None] + np.array([9.0, 5.0, 3.0])))
    assert float(found.order_standard_error) == pytest.approx(0.0, abs=1e-12)
    assert float(found.limit_standard_error) == pytest.approx(level.std(ddof=1) / 2, rel=1e-12)
