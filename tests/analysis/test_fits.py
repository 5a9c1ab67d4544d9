"""Fits of the area of rough lines (Eq. 3.11): planted parameters are found, and their jackknife is honest."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import t as student

from contactsim.analysis.fits import WEIGHTINGS, fit_line_area, fit_line_areas
from contactsim.reference import hard_wall
from support.ensembles import ensemble

LOADS = np.geomspace(1e-3, 1, 12)
PLANTED = {0.2: (0.6, 1.3), 0.8: (0.9, 4.0)}


@pytest.mark.parametrize("weighting", WEIGHTINGS)
@pytest.mark.parametrize("planted", [*PLANTED.values(), (1.3, 0.5)])
def test_a_fit_recovers_the_planted_parameters(planted, weighting):
    area = np.tile(hard_wall.line_area(LOADS, *planted), (2, 3, 1))
    # Convergence of least squares to 1e-8 of the cost, which is quadratic: half the digits of b2, the looser one.
    np.testing.assert_allclose(fit_line_area(LOADS, area, weighting), planted, rtol=1e-4)


def noisy(planted, members, size, seed):
    draw = np.random.default_rng(seed)
    clean = hard_wall.line_area(LOADS, *planted)
    return clean * (1 + size * draw.standard_normal((1, members, LOADS.size)))


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_a_fit_of_noisy_areas_is_the_least_of_its_own_sum_of_squares(weighting):
    area = noisy(PLANTED[0.2], 3, 0.05, 0)

    def cost(b1, b2):
        model = hard_wall.line_area(LOADS, b1, b2)
        return np.sum((model - area) ** 2 if weighting == "area" else np.log(model / area) ** 2)

    b1, b2 = fit_line_area(LOADS, area, weighting)
    for change in ((1.01, 1), (0.99, 1), (1, 1.02), (1, 0.98), (1.01, 1.02), (0.99, 0.98)):
        assert cost(b1, b2) < cost(b1 * change[0], b2 * change[1])


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_a_fit_leaves_out_areas_that_are_not_known_or_zero(weighting):
    area = np.tile(hard_wall.line_area(LOADS, *PLANTED[0.2]), (1, 3, 1))
    area[0, 0, 3] = np.nan
    area[0, 1, :2] = 0.0
    np.testing.assert_allclose(fit_line_area(LOADS, area, weighting), PLANTED[0.2], rtol=1e-4)


@pytest.mark.parametrize("area", [np.full((1, 3, 12), np.nan), np.zeros((1, 3, 0))], ids=["unknown", "no loads"])
def test_a_fit_of_nothing_finds_nothing(area):
    assert np.isnan(fit_line_area(LOADS[: area.shape[-1]], area, "area")).all()


def line(members=4, noise=0.0, seed=0, bad=()):
    """A dataset with the areas of Eq. 3.11, other parameters for each Hurst exponent, and noise."""
    area = np.concatenate([noisy(planted, members, noise, [seed, k]) for k, planted in enumerate(PLANTED.values())])
    data = ensemble(area, bad).rename(kappa="relative_contact_area")
    return data.assign_coords(hurst_exponent=list(PLANTED), reduced_pressure=LOADS)


def test_each_hurst_exponent_is_fitted_by_itself_and_all_together():
    found = fit_line_areas(line(), [1.0])
    assert found.fitted.values.tolist() == ["0.2", "0.8", "all"]
    assert found.weighting.values.tolist() == list(WEIGHTINGS)
    for hurst_exponent, (b1, b2) in PLANTED.items():
        one = found.sel(fitted=f"{hurst_exponent:g}")
        np.testing.assert_allclose(one.fit_b1, b1, rtol=1e-4)
        np.testing.assert_allclose(one.fit_b2, b2, rtol=1e-4)
    between = found.sel(fitted="all").fit_b1.values
    assert ((between > 0.6) & (between < 0.9)).all()


def test_a_limit_leaves_out_larger_pressures_and_keeps_the_one_at_the_limit():
    data = line()
    data["relative_contact_area"][:, :, LOADS > 0.11] = 0.99
    limit = LOADS[LOADS < 0.11][-1]
    data["relative_contact_area"][:, :, np.isclose(LOADS, limit)] *= 1.5
    found = fit_line_areas(data, [0.9 * limit, limit])
    planted = np.array([[b1] * 2 for b1, _ in PLANTED.values()])
    below = found.fit_b1.isel(fitted=[0, 1], fit_limit=0).values
    # Up to 0.048 the area hardly depends on b2, so that b1 has fewer digits than in the fits above.
    np.testing.assert_allclose(below, planted, rtol=1e-3)
    assert (abs(found.fit_b1.isel(fitted=[0, 1], fit_limit=1).values / planted - 1) > 0.01).all()


def test_unconverged_areas_are_left_out_of_a_fit():
    data = line(bad=[(0, 1, 5)])
    data["relative_contact_area"][0, 1, 5] = 0.9
    np.testing.assert_allclose(fit_line_areas(data, [1.0]).fit_b1.sel(fitted="0.2"), PLANTED[0.2][0], rtol=1e-4)


def test_a_hurst_exponent_that_never_converged_has_no_fit_and_spoils_no_other():
    found = fit_line_areas(line(bad=[(0, slice(None), slice(None))]), [1.0])
    for name in ("fit_b1", "fit_b1_half_width"):
        assert np.isnan(found[name].sel(fitted="0.2")).all()
        assert np.isfinite(found[name].sel(fitted=["0.8", "all"])).all()
    np.testing.assert_allclose(found.fit_b1.sel(fitted="all"), PLANTED[0.8][0], rtol=1e-4)


def test_the_jackknife_of_a_mean_is_the_confidence_interval_of_a_mean(monkeypatch):
    mean = "contactsim.analysis.fits.fit_line_area"
    monkeypatch.setattr(mean, lambda pressure, area, weighting: (area.mean(), -2 * area.mean()))
    data = line(members=7, noise=0.1)
    found = fit_line_areas(data, [1.0]).sel(fitted="0.8", weighting="area", fit_limit=1.0)
    means = data.relative_contact_area.sel(hurst_exponent=0.8).mean("reduced_pressure").values
    half_width = student.ppf(0.975, 6) * means.std(ddof=1) / np.sqrt(7)
    assert found.fit_b1_half_width.item() == pytest.approx(half_width, rel=1e-10)
    assert found.fit_b2_half_width.item() == pytest.approx(2 * half_width, rel=1e-10)


def test_the_half_width_is_that_of_the_scatter_between_ensembles():
    members, ensembles = 6, 24
    found = [fit_and_half_width(noisy(PLANTED[0.2], members, 0.05, [1, k])) for k in range(ensembles)]
    b1, half_width = np.array(found).T
    ratio = np.sqrt(np.mean(half_width**2)) / (student.ppf(0.975, members - 1) * b1.std(ddof=1))
    # The spread of 24 is known to 1/√46 = 15 % of itself, the mean of 24 squared half-widths to about 7 %: 2.4 sigma.
    assert ratio == pytest.approx(1, abs=0.4)
    assert abs(b1.mean() - PLANTED[0.2][0]) < 4 * b1.std(ddof=1) / np.sqrt(ensembles)


def fit_and_half_width(area):
    data = ensemble(area).rename(kappa="relative_contact_area").assign_coords(reduced_pressure=LOADS)
    one = fit_line_areas(data, [1.0]).isel(fitted=0, fit_limit=0).sel(weighting="area")
    return one.fit_b1.item(), one.fit_b1_half_width.item()


def test_two_members_are_too_few_for_a_half_width():
    found = fit_line_areas(line(members=2), [1.0])
    assert np.isnan(found.fit_b1_half_width).all()
    assert np.isfinite(found.fit_b1).all()
