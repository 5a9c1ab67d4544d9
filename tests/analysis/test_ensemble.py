"""Differences between the means of ensembles, with the errors of paired and of independent members."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.analysis.ensemble import departure, relative_change
from contactsim.errors import InputError
from support.ensembles import bodies, ensemble


def test_a_difference_planted_between_two_loads_is_found_member_by_member():
    draw = np.random.default_rng(0)
    # Members differ by far more than loads do, so that only paired differences can see it.
    values = 10 * draw.random((2, 6, 1)) + 1e-3 * draw.random((2, 6, 4))
    values[1, :, 3] += 0.5
    found = departure(ensemble(values), "kappa", "reduced_pressure")
    assert {place["hurst_exponent"] for place in found.places} == {0.1}
    assert found.places[1]["reduced_pressure"] == pytest.approx(0.3)
    first = round(found.places[0]["reduced_pressure"] * 10)
    pairs = values[1, :, 3] - values[1, :, first]
    error = pairs.std(ddof=1) / np.sqrt(6)
    assert found.difference == pytest.approx(pairs.mean(), rel=1e-12)
    assert found.standard_error == pytest.approx(error, rel=1e-9)  # a difference of numbers near 10: 1e-15/1e-4
    assert found.in_errors == pytest.approx(pairs.mean() / error, rel=1e-9)


def test_a_difference_planted_between_two_hurst_exponents_is_found_with_independent_errors():
    values = np.random.default_rng(1).random((3, 5, 4))
    values[2, :, 1] += 3.0
    found = departure(ensemble(values), "kappa", "hurst_exponent")
    assert [place["reduced_pressure"] for place in found.places] == [0.1, 0.1]
    first = round(found.places[0]["hurst_exponent"] * 10)
    assert (first, found.places[1]["hurst_exponent"]) in {(0, 0.2), (1, 0.2)}
    one, two = values[first, :, 1], values[2, :, 1]
    assert found.difference == pytest.approx(two.mean() - one.mean(), rel=1e-12)
    error = np.sqrt(one.var(ddof=1) / 5 + two.var(ddof=1) / 5)
    assert found.standard_error == pytest.approx(error, rel=1e-12)


def test_the_departure_is_the_most_significant_of_all():
    values = np.random.default_rng(2).random((3, 5, 4))
    found = departure(ensemble(values), "kappa", "hurst_exponent").in_errors
    each = [
        abs(values[i, :, k].mean() - values[j, :, k].mean())
        / np.sqrt((values[i, :, k].var(ddof=1) + values[j, :, k].var(ddof=1)) / 5)
        for i in range(3)
        for j in range(i)
        for k in range(4)
    ]
    assert found == pytest.approx(max(each), rel=1e-12)


def test_unconverged_members_make_the_error_of_a_difference_larger():
    values = np.random.default_rng(3).random((2, 6, 2))
    bad = [(0, 0, 0), (0, 1, 0), (0, 2, 0)]
    found = departure(ensemble(values[:, :, :1], bad), "kappa", "hurst_exponent")
    one, two = values[0, 3:, 0], values[1, :, 0]
    assert found.difference == pytest.approx(abs(one.mean() - two.mean()), rel=1e-12)
    assert found.standard_error == pytest.approx(np.sqrt(one.var(ddof=1) / 3 + two.var(ddof=1) / 6), rel=1e-12)
    paired = departure(ensemble(values[:1], bad), "kappa", "reduced_pressure")
    pairs = values[0, 3:, 0] - values[0, 3:, 1]
    assert paired.difference == pytest.approx(abs(pairs.mean()), rel=1e-12)
    assert paired.standard_error == pytest.approx(pairs.std(ddof=1) / np.sqrt(3), rel=1e-12)


def test_a_difference_between_two_bodies_is_found_member_by_member():
    values = 10 * np.random.default_rng(5).random((1, 6, 1)) + np.zeros((2, 1, 1))
    values[1] += 1e-3 * (1 + np.random.default_rng(6).random((6, 1)))
    found = departure(bodies(values), "kappa", "poisson_ratio")
    pairs = values[1, :, 0] - values[0, :, 0]
    assert found.difference == pytest.approx(pairs.mean(), rel=1e-9)  # a difference of numbers near 10: 1e-15/1e-3
    assert found.standard_error == pytest.approx(pairs.std(ddof=1) / np.sqrt(6), rel=1e-9)


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


def test_a_load_that_never_converged_is_passed_over():
    values = np.random.default_rng(4).random((1, 4, 3))
    lost = departure(ensemble(values, [(0, member, 0) for member in range(4)]), "kappa", "reduced_pressure")
    kept = departure(ensemble(values).isel(reduced_pressure=[1, 2]), "kappa", "reduced_pressure")
    assert lost == kept


def test_without_a_spread_nothing_is_significant_and_that_is_said():
    with pytest.raises(InputError, match=r"members: got 1; allowed: 2 or more"):
        departure(ensemble(np.ones((2, 1, 2))), "kappa", "hurst_exponent")


def test_without_two_values_there_is_no_difference_and_that_is_said():
    with pytest.raises(InputError, match=r"hurst_exponent.*2 or more"):
        departure(ensemble(np.random.default_rng(5).random((1, 4, 2))), "kappa", "hurst_exponent")
