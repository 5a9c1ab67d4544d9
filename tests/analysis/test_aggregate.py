"""Runs become one dataset: dimensions, derived quantities, means, errors of grid and tolerance."""

from __future__ import annotations

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from contactsim import dataset, variables
from contactsim.analysis import aggregate
from contactsim.analysis.ensemble import unconverged
from contactsim.observables import derived
from contactsim.observables.dataset_forms import AVERAGED, KEPT_NUMBERS, load_dimension
from contactsim.status import Status
from support import rough_study

PRESSURES = [0.01, 0.1, 0.3]
HURSTS = [0.2, 0.8]
MODULUS = 2.0
GRADIENT = 0.01
CONVERGED, MAX_ITERATIONS, NON_FINITE, *_ = (status.value[0] for status in Status)
SETTINGS = {"title": "A study", "fit_limits": None, "surface": {"radius": 50.0}}


def numbers(hurst_exponent, member, coarse=False):
    """What a run found, made up but reproducible: one value per load for each quantity."""
    draw = np.random.default_rng([int(10 * hurst_exponent), member, coarse])
    return {
        "relative_contact_area": np.array(PRESSURES) * (1.5 + 0.3 * hurst_exponent + 0.1 * draw.random(len(PRESSURES))),
        "relative_contact_area_subgrid": np.array(PRESSURES) * 1.4,
        "relative_contact_area_corrected": np.array(PRESSURES) * 1.45,
        "rms_gradient_contact_subgrid": np.full(len(PRESSURES), GRADIENT),
        "rms_gradient_contact_corrected": np.full(len(PRESSURES), 0.95 * GRADIENT),
        "rms_gradient_contact": GRADIENT * (1 + 0.1 * draw.random(len(PRESSURES))),
        "rms_gradient_contact_pairs": GRADIENT * (1 - 0.1 * draw.random(len(PRESSURES))),
        "mean_gap": draw.random(len(PRESSURES)),
        "max_pressure": draw.random(len(PRESSURES)),
    }


def run_dataset(hurst_exponent, member, coarse, status, load, changes):
    """The dataset of one run: what it found, its status at each load, and arrays that stay with it."""
    values = numbers(hurst_exponent, member, coarse) | changes
    data = xr.Dataset(
        {name: (load, value) for name, value in values.items()}
        | {"mean_pressure": (load, np.asarray(PRESSURES) * MODULUS * GRADIENT), "status": (load, status)}
        | {"point_digest": (load, [f"digest{row}" for row in range(len(PRESSURES))])}
        | {"contact_bits": ((load, "byte"), np.zeros((len(PRESSURES), 8), np.uint8))}
        | {"contact_pressure": ("contact_point", np.zeros(5 + member, np.float32))}
        | {"profile_real": ("mode", np.ones(4)), "profile_imag": ("mode", np.ones(4))}
        | {"rms_height": 1.0 + member, "points": 32 if coarse else 64, "length": 640.0}
        | {"contact_modulus": MODULUS, "seed": 1},
        {load: PRESSURES},
        {"problem": "hard_wall"},
    )
    return dataset.stamp(dataset.describe(data), "run", {}, "source")


@pytest.fixture
def runs(tmp_path):
    """Write the runs of a study: members, those on the coarse grid, and the places that did not converge."""

    def write(members=4, coarse_members=0, bad=(), load="reduced_pressure", change=lambda hurst_exponent, member: {}):
        listed = []
        for coarse, count in ((False, members), (True, coarse_members)):
            for hurst_exponent, member in product(HURSTS, range(count)):
                place = hurst_exponent, member, coarse
                status = [dict(bad).get((*place, row), CONVERGED) for row in range(len(PRESSURES))]
                data = run_dataset(*place, np.array(status, np.int8), load, change(hurst_exponent, member))
                path = tmp_path / f"{hurst_exponent}_{member}_{coarse}.nc"
                dataset.write(data, path)
                coordinates = {"hurst_exponent": hurst_exponent}
                listed.append({"path": path, "coordinates": coordinates, "member": member, "measures_error": coarse})
        return listed

    return write


def made(runs, **settings):
    return aggregate.aggregate(runs, SETTINGS | settings, "source")


def by_hand(name, hurst_exponent, row, members, coarse=False):
    return np.array([numbers(hurst_exponent, member, coarse)[name][row] for member in members])


# --- one dataset --------------------------------------------------------------------------------------------------


def test_runs_become_one_dataset_over_varied_keys_members_and_loads(runs):
    data = made(runs())
    assert dict(data.sizes) == {"hurst_exponent": 2, "member": 4, "reduced_pressure": 3}
    assert data.relative_contact_area.dims == ("hurst_exponent", "member", "reduced_pressure")
    for hurst_exponent in HURSTS:
        for member in range(4):
            for name, values in numbers(hurst_exponent, member).items():
                assert data[name].sel(hurst_exponent=hurst_exponent, member=member).values.tolist() == values.tolist()
    assert data.rms_height.values.tolist() == [[1.0, 2.0, 3.0, 4.0]] * 2
    assert (data.points.item(), data.length.item(), data.contact_modulus.item()) == (64, 640.0, MODULUS)


def test_the_order_of_the_runs_does_not_matter(runs):
    listed = runs(coarse_members=2)
    xr.testing.assert_identical(made(listed), made(listed[::-1]))


def test_everything_has_units_and_a_long_name_and_the_study_is_stamped(runs):
    data = made(runs(coarse_members=2), fit_limits=[1.0])
    for name, item in data.variables.items():
        assert set(item.attrs) >= {"units", "long_name"}, name
    assert data.kappa_mean.long_name.endswith(": mean over members")
    assert data.attrs["title"] == "A study"
    assert dataset.settings_of(data)["fit_limits"] == [1.0]
    assert data.attrs["source_digest"] == "source"


def test_contact_sets_pressures_and_profiles_stay_with_the_runs(runs):
    assert not set(derived.RUN_ONLY_VARIABLES) & set(made(runs()).variables)


def test_proportionality_factors_follow_from_area_gradient_and_pressure(runs):
    data = made(runs())
    pressure = np.array(PRESSURES) * MODULUS * GRADIENT
    for hurst_exponent, member in ((0.2, 0), (0.8, 3)):
        one, found = data.sel(hurst_exponent=hurst_exponent, member=member), numbers(hurst_exponent, member)
        area, gradient = found["relative_contact_area"], found["rms_gradient_contact"]
        # Rounding of a handful of products.
        np.testing.assert_allclose(one.kappa, area / PRESSURES, rtol=1e-14)
        np.testing.assert_allclose(one.kappa_r, area * gradient * MODULUS / pressure, rtol=1e-14)
        bond = found["rms_gradient_contact_pairs"]
        np.testing.assert_allclose(one.kappa_r_pairs, area * bond * MODULUS / pressure, rtol=1e-14)
        np.testing.assert_allclose(one.reduced_pressure_contact, pressure / (gradient * MODULUS), rtol=1e-14)
        corrected = found["rms_gradient_contact_corrected"]
        expected = pressure / (corrected * MODULUS)
        np.testing.assert_allclose(one.reduced_pressure_contact_corrected, expected, rtol=1e-14)
        for estimator in ("corrected", "subgrid"):
            area, gradient = found[f"relative_contact_area_{estimator}"], found[f"rms_gradient_contact_{estimator}"]
            np.testing.assert_allclose(one[f"kappa_{estimator}"], area / PRESSURES, rtol=1e-14)
            expected = area * gradient * MODULUS / pressure
            np.testing.assert_allclose(one[f"kappa_r_{estimator}"], expected, rtol=1e-14)


def test_a_cylinder_has_its_half_width_beside_the_exact_one(runs):
    data = made(runs(load="contact_ratio"))
    np.testing.assert_allclose(data.half_width_exact, np.array(PRESSURES) * 50.0, rtol=1e-15)
    np.testing.assert_allclose(data.half_width, data.relative_contact_area * 640.0 / 2, rtol=1e-15)
    assert "kappa" not in data
    assert load_dimension(data) == "contact_ratio"


def test_a_varied_radius_gives_each_cylinder_its_own_exact_half_width(runs):
    listed = runs(members=1, load="contact_ratio")
    for run, radius in zip(listed, (20.0, 30.0), strict=True):
        run["coordinates"] = {"radius": radius}
    exact = made(listed).half_width_exact
    for radius in (20.0, 30.0):
        np.testing.assert_allclose(exact.sel(radius=radius), np.array(PRESSURES) * radius, rtol=1e-15)


# --- means --------------------------------------------------------------------------------------------------------


def test_means_and_standard_errors_are_numpys(runs):
    data = made(runs())
    for name in ("relative_contact_area", "mean_gap", "rms_gradient_contact"):
        for hurst_exponent in HURSTS:
            for row in range(3):
                values = by_hand(name, hurst_exponent, row, range(4))
                here = data.sel(hurst_exponent=hurst_exponent).isel(reduced_pressure=row)
                assert here[f"{name}_mean"].item() == pytest.approx(values.mean(), rel=1e-14)
                error = values.std(ddof=1) / np.sqrt(4)
                assert here[f"{name}_standard_error"].item() == pytest.approx(error, rel=1e-12)


def test_every_averaged_quantity_has_mean_error_and_grid_error(runs):
    data = made(runs(coarse_members=2))
    for name in set(AVERAGED) - set(KEPT_NUMBERS):
        for suffix in ("_mean", "_standard_error", "_grid_error"):
            assert data[f"{name}{suffix}"].dims == ("hurst_exponent", "reduced_pressure")
            assert np.isfinite(data[f"{name}{suffix}"]).all()


def test_unconverged_solutions_are_left_out_of_means_and_errors_and_counted(runs):
    data = made(runs(bad={(0.2, 1, False, 0): MAX_ITERATIONS, (0.8, 2, False, 2): NON_FINITE}))
    assert unconverged(data) == (2, 24)
    for hurst_exponent, row, members in ((0.2, 0, [0, 2, 3]), (0.8, 2, [0, 1, 3]), (0.2, 1, range(4))):
        values = by_hand("mean_gap", hurst_exponent, row, members)
        here = data.sel(hurst_exponent=hurst_exponent).isel(reduced_pressure=row)
        assert here.mean_gap_mean.item() == pytest.approx(values.mean(), rel=1e-14)
        error = values.std(ddof=1) / np.sqrt(len(values))
        assert here.mean_gap_standard_error.item() == pytest.approx(error, rel=1e-12)


def test_what_did_not_converge_stays_in_the_dataset_with_its_status(runs):
    data = made(runs(bad={(0.2, 1, False, 0): MAX_ITERATIONS}))
    one = data.sel(hurst_exponent=0.2, member=1).isel(reduced_pressure=0)
    assert one.status.item() == MAX_ITERATIONS
    assert one.mean_gap.item() == numbers(0.2, 1)["mean_gap"][0]
    assert data.status.attrs["flag_meanings"].startswith("converged max_iterations non_finite ")


def test_one_converged_member_has_a_mean_but_no_error_and_none_has_neither(runs):
    one = {(0.2, member, False, 0): MAX_ITERATIONS for member in (1, 2, 3)}
    none = {(0.8, member, False, 0): MAX_ITERATIONS for member in range(4)}
    data = made(runs(bad=one | none)).isel(reduced_pressure=0)
    assert data.sel(hurst_exponent=0.2).mean_gap_mean.item() == numbers(0.2, 0)["mean_gap"][0]
    assert np.isnan(data.sel(hurst_exponent=0.8).mean_gap_mean)
    assert np.isnan(data.mean_gap_standard_error).all()


def test_a_single_member_has_a_mean_and_no_error(runs):
    data = made(runs(members=1))
    assert data.mean_gap_mean.values.tolist() == [
        numbers(hurst_exponent, 0)["mean_gap"].tolist() for hurst_exponent in HURSTS
    ]
    assert np.isnan(data.mean_gap_standard_error).all()


def test_a_quantity_without_contact_is_left_out_like_an_unconverged_one(runs):
    data = made(
        runs(change=lambda hurst_exponent, member: {"rms_gradient_contact": [np.nan if member == 0 else 0.1] * 3})
    )
    np.testing.assert_allclose(data.rms_gradient_contact_mean, 0.1, rtol=1e-15)


# --- grid error ---------------------------------------------------------------------------------------------------


def test_the_grid_error_is_the_change_of_the_mean_over_the_members_of_both_grids(runs):
    data = made(runs(coarse_members=2))
    for hurst_exponent in HURSTS:
        for row in range(3):
            fine, coarse = (by_hand("mean_gap", hurst_exponent, row, range(2), coarse) for coarse in (False, True))
            found = data.mean_gap_grid_error.sel(hurst_exponent=hurst_exponent).isel(reduced_pressure=row).item()
            assert found == pytest.approx(abs(fine.mean() - coarse.mean()), rel=1e-12)


def test_the_grid_error_has_a_standard_error_over_the_members_of_both_grids(runs):
    data = made(runs(coarse_members=3))
    fine, coarse = (by_hand("mean_gap", 0.2, 1, range(3), coarse) for coarse in (False, True))
    found = data.mean_gap_grid_change_standard_error.sel(hurst_exponent=0.2).isel(reduced_pressure=1).item()
    assert found == pytest.approx((fine - coarse).std(ddof=1) / np.sqrt(3), rel=1e-12)
    assert data.mean_gap_grid_change_standard_error.long_name.endswith("change on halving the grid")
    assert "mean_gap_grid_change_standard_error" not in made(runs(coarse_members=1))


@pytest.mark.parametrize("is_coarse", [False, True])
def test_a_member_unconverged_on_either_grid_leaves_the_grid_error_unknown(runs, is_coarse):
    data = made(runs(coarse_members=3, bad={(0.2, 1, is_coarse, 0): MAX_ITERATIONS}))
    errors = data.mean_gap_grid_error.transpose("hurst_exponent", ...)
    assert np.isnan(errors.sel(hurst_exponent=0.2).isel(reduced_pressure=0))
    assert int(errors.isnull().sum()) == 1
    assert unconverged(data) == (int(not is_coarse), 24)  # of the study's own solutions


def test_without_coarse_runs_there_is_no_grid_error(runs):
    assert not [name for name in made(runs()).variables if str(name).endswith("_grid_error")]


def test_a_study_with_fit_limits_gets_its_fits(runs):
    data = made(runs(), fit_limits=[0.2, 1.0])
    assert data.fit_b1.dims == ("fitted", "weighting", "fit_limit")
    assert data.fit_limit.values.tolist() == [0.2, 1.0]
    assert (data.fit_b1.units, data.fit_b1_half_width.units) == ("1", "1")
    assert "fit_b1" not in made(runs())


def test_an_aggregated_study_can_be_written_and_read(runs, tmp_path):
    data = made(runs(coarse_members=2), fit_limits=[1.0])
    dataset.write(data, tmp_path / "study.nc")
    xr.testing.assert_identical(dataset.load_dataset(tmp_path / "study.nc"), data)


def test_a_load_is_named_by_the_dimension_that_it_is():
    for name in variables.LOADS:
        assert load_dimension(SimpleNamespace(dims=("member", name))) == name


def test_the_tolerance_error_is_the_change_on_solving_more_tightly_and_apart_from_the_grid_error(runs):
    listed = runs(coarse_members=2)
    tight = [run | {"error": "tolerance"} for run in listed if run["measures_error"]]
    data = made([run for run in listed if not run["measures_error"]] + tight)
    assert "mean_gap_grid_error" not in data
    both = made(listed)
    assert np.array_equal(data.mean_gap_tolerance_error, both.mean_gap_grid_error)
    assert "solving more tightly" in data.mean_gap_tolerance_error.long_name


def test_the_grid_error_of_a_summary_is_the_largest_change_of_a_member(tmp_path):
    grids = {"surface/rms_gradient": 0.3, "points": 64, "coarse_grid": {"points": 32, "members": 3}}
    paths = rough_study.study(rough_study.WALKED | grids | {"vary": {}, "members": 3})
    listed = rough_study.executed(paths, tmp_path)
    data = aggregate.aggregate(listed, paths.settings, "source")
    fine, coarse = (
        np.array(
            [dataset.load_dataset(run["path"]).line_load.values[-1] for run in listed if run["measures_error"] is of]
        )
        for of in (False, True)
    )
    change = fine - coarse
    assert np.abs(change).max() > 1.1 * abs(change.mean())
    assert float(data.final_load_grid_error) == pytest.approx(np.abs(change).max(), rel=1e-12)
    assert float(data.final_load_grid_change) == pytest.approx(change.mean(), rel=1e-12)
