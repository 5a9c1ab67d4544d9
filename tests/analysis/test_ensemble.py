"""Differences between the means of ensembles, with the errors of paired members."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.analysis.ensemble import ratio_of_means, relative_change
from support.ensembles import bodies


def test_a_relative_change_is_that_of_the_same_members():
    values = 1 + np.random.default_rng(7).random((2, 5, 3))
    found = relative_change(bodies(values, [(1, 4, 0)]), "kappa", "poisson_ratio", 0.0)
    assert (found.kappa_change.sel(poisson_ratio=0.0) == 0).all()
    for load, known in ((0, slice(0, 4)), (1, slice(0, 5))):
        pairs, level = values[1, known, load] - values[0, known, load], values[0, known, load].mean()
        count = len(pairs)
        one = found.isel(poisson_ratio=1, reduced_pressure=load)
        assert one.kappa_change.item() == pytest.approx(pairs.mean() / level, rel=1e-12)
        error = pairs.std(ddof=1) / np.sqrt(count) / level
        assert one.kappa_change_standard_error.item() == pytest.approx(error, rel=1e-12)


def test_the_relative_change_of_one_member_has_no_error():
    found = relative_change(bodies(np.ones((2, 1, 3))), "kappa", "poisson_ratio", 0.0)
    assert (found.kappa_change == 0).all()
    assert found.kappa_change_standard_error.isnull().all()


def test_the_error_of_a_ratio_is_that_of_two_independent_ensembles():
    above, below = (
        xr.Dataset({"kappa_mean": mean, "kappa_standard_error": error}) for mean, error in ((3, 0.09), (2, 0.08))
    )
    ratio = ratio_of_means(above, below, "kappa")
    assert ratio.value.item() == 1.5
    assert ratio.error.item() == pytest.approx(1.5 * 0.05)  # 3 % and 4 %
