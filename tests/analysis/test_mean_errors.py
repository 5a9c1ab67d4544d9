"""Errors of means and of ratios that figures show, by the rules of verdicts."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.analysis.aggregate import ensemble_means
from contactsim.analysis.claims import judge
from contactsim.analysis.mean_errors import estimate_trend, grid_error, mean_error
from contactsim.analysis.quantities import mean_quantity
from contactsim.analysis.ratios import ratio_curves
from contactsim.observables.dataset_forms import AVERAGED
from support.claims import PRESSURES, claim, made_up, with_corrected


def averaged(data):
    """The dataset with means, standard errors and sizes of the changes on halving the grid."""
    names = [name.removesuffix("_grid_change") for name in data if name.endswith("_grid_change")]
    sizes = {f"{name}_grid_error": abs(data[f"{name}_grid_change"]) for name in names}
    return data.merge(ensemble_means(data, AVERAGED)).assign(sizes)


def lines(corrected=1.9, change=0.01, subgrid=1.9, points=262144, **others):
    """Means of rough lines, counted κ changing by -0.05 on halving the grid."""
    made = made_up(grid=-0.05, scatter=0.1, points=points, **others)
    return averaged(with_corrected(made, corrected, change, subgrid))


def test_counted_points_have_a_grid_error_but_on_the_thesis_grid():
    assert grid_error(lines(), "kappa") == 0.0
    assert np.allclose(grid_error(lines(points=131072), "kappa"), 0.05)


def test_the_grid_error_of_a_corrected_mean_is_at_least_the_distance_to_edges_between_points():
    assert np.allclose(grid_error(lines(subgrid=1.93), "kappa_corrected"), 0.03)
    assert np.allclose(grid_error(lines(subgrid=1.9), "kappa_corrected"), 0.01)
    unresolved = lines(subgrid=1.93, points=32768)  # 8 points per shortest wavelength
    assert np.allclose(grid_error(unresolved, "kappa_corrected"), 0.01)


def test_both_errors_of_a_mean_add_in_quadrature():
    data = lines(points=131072)
    scatter = 0.1 * np.std([-1, -1 / 3, 1 / 3, 1], ddof=1) / 2
    assert np.allclose(mean_error(data, "kappa"), np.hypot(scatter, 0.05))
    assert np.allclose(mean_error(data.drop_vars("kappa_grid_error"), "kappa"), scatter)
    one = lines(members=1, points=131072)
    assert np.allclose(mean_error(one, "kappa"), 0.05)  # one member has no scatter


def test_a_trend_is_that_of_a_claim():
    trend = estimate_trend(lines(tilt=0.2), "kappa", "reduced_pressure")
    assert trend.value == pytest.approx(0.2, rel=1e-9)  # from 1.8 to 2.2 over a mean of 2
    assert trend.ensemble_error == pytest.approx(0.0, abs=0.02)
    assert np.isfinite(trend.grid_error)


def test_a_ratio_halves_both_grids_together():
    above, below = lines(corrected=1.8, change=-0.1, subgrid=1.8), lines(corrected=2.0, change=-0.1, subgrid=2.0)
    rows = ratio_curves(above, below, "kappa_corrected")
    assert len(rows) == 2 * len(PRESSURES)
    assert np.allclose(rows.value, 0.9)
    assert np.allclose(rows.error, abs(1.9 / 2.1 - 0.9))  # 0.0048, where apart they are 0.05
    shifted = ratio_curves(
        above.assign(kappa_subgrid_mean=above.kappa_subgrid_mean * 0 + 1.9), below, "kappa_corrected"
    )
    assert np.allclose(shifted.error, 0.05)


def test_a_ratio_is_taken_at_the_loads_of_both():
    rows = ratio_curves(lines(), lines().isel(reduced_pressure=[0, 2]), "kappa_corrected")
    assert sorted(set(rows.reduced_pressure)) == [PRESSURES[0], PRESSURES[2]]


def test_the_deficit_of_the_gradient_is_that_of_both_factors():
    data = averaged(
        made_up().assign(
            rms_gradient_contact_corrected=made_up().kappa * 0 + 0.0008,
            rms_gradient_contact_subgrid=made_up().kappa * 0 + 0.00079,
            rms_gradient_contact_corrected_grid_change=made_up().kappa_grid_change * 0 - 0.00002,
            rms_gradient=("member", np.full(4, 0.001)),
        )
    )
    assert np.allclose(mean_quantity(data, "gradient_deficit_corrected"), 0.2)
    settings = claim(quantity="gradient_deficit_corrected", reduce="mean", expect=0.2, tolerance=0.1)
    row = judge(settings, [data])
    assert row["value"] == pytest.approx(0.2)
    assert row["grid_error"] == pytest.approx(0.02)  # the change of ḡ_r, larger than the distance between estimators


def test_the_shape_of_a_ratio_is_compared_with_that_of_the_first_study():
    above, below = made_up(tilt=0.2, scatter=0.01), made_up(tilt=-0.2, scatter=0.01)
    settings = claim(
        quantity="kappa", against="kappa", reduce="correlation", relative_to="rough_surface", expect=None,
        tolerance=None, at_least=0.9,
    )  # fmt: skip
    row = judge(settings, [above, below])
    assert row["value"] == pytest.approx(1.0, abs=1e-2)
    assert row["verdict"] == "reproduced"
    falling = made_up(tilt=0.6, scatter=0.01)  # the ratio falls where the first study rises
    assert judge(settings, [above, falling])["value"] < -0.9
