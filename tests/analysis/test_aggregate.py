from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from scipy.stats import t as student

from contactsim import dataset, reference, variables
from contactsim.analysis import aggregate
from contactsim.analysis.ensemble import departure, relative_change, unconverged
from contactsim.analysis.fits import WEIGHTINGS, fit_line_area, fits
from contactsim.errors import InputError
from contactsim.observables import derived
from contactsim.observables.dataset_forms import AVERAGED, load_dimension
from contactsim.status import Status

PRESSURES = [0.01, 0.1, 0.3]
HURSTS = [0.2, 0.8]
MODULUS = 2.0
GRADIENT = 0.01
CONVERGED, MAX_ITERATIONS, NON_FINITE, *_ = (status.value[0] for status in Status)
SETTINGS = {"title": "A study", "fit_limits": None, "surface": {"radius": 50.0}}


def numbers(hurst_exponent, member, companion=False, loads=PRESSURES):
    """What a run found, made up but reproducible: one value per load for each quantity."""
    draw = np.random.default_rng([int(10 * hurst_exponent), member, companion])
    return {
        "relative_contact_area": np.asarray(loads) * (1.5 + 0.3 * hurst_exponent + 0.1 * draw.random(len(loads))),
        "relative_contact_area_subgrid": np.asarray(loads) * 1.4,
        "rms_gradient_contact": GRADIENT * (1 + 0.1 * draw.random(len(loads))),
        "rms_gradient_contact_pairs": GRADIENT * (1 - 0.1 * draw.random(len(loads))),
        "mean_gap": draw.random(len(loads)),
    }


@pytest.fixture
def runs(tmp_path):
    """Write the runs of a study: members, those of the companion, and the places that did not converge."""

    def write(members=4, companions=0, bad=(), load="reduced_pressure", loads=PRESSURES, change=None):
        listed = []
        for companion, count in ((False, members), (True, companions)):
            for hurst_exponent in HURSTS:
                for member in range(count):
                    found = numbers(hurst_exponent, member, companion, loads) | (
                        change(hurst_exponent, member) if change else {}
                    )
                    status = [bad_status(bad, hurst_exponent, member, companion, row) for row in range(len(loads))]
                    pressure = np.asarray(loads) * MODULUS * GRADIENT
                    data = xr.Dataset(
                        {name: (load, values) for name, values in found.items()}
                        | {"mean_pressure": (load, pressure), "status": (load, np.array(status, np.int8))}
                        | {"point_digest": (load, [f"digest{row}" for row in range(len(loads))])}
                        | {"contact_bits": ((load, "byte"), np.zeros((len(loads), 8), np.uint8))}
                        | {"contact_pressure": ("contact_point", np.zeros(5 + member, np.float32))}
                        | {"profile_real": ("mode", np.ones(4)), "profile_imag": ("mode", np.ones(4))}
                        | {"rms_height": 1.0 + member, "points": 32 if companion else 64, "length": 640.0}
                        | {"contact_modulus": MODULUS, "seed": 1},
                        {load: list(loads)},
                        {"problem": "hard_wall"},
                    )
                    path = tmp_path / f"{hurst_exponent}_{member}_{companion}.nc"
                    dataset.write(dataset.stamped(dataset.described(data), "run", {}, "source"), path)
                    place = {
                        "path": path,
                        "coordinates": {"hurst_exponent": hurst_exponent},
                        "member": member,
                        "measures_error": companion,
                    }
                    listed.append(place)
        return listed

    return write


def bad_status(bad, hurst_exponent, member, companion, row):
    return dict(bad).get((hurst_exponent, member, companion, row), CONVERGED)


def made(runs, **settings):
    return aggregate.aggregate(runs, SETTINGS | settings, "source")


def by_hand(name, hurst_exponent, row, members, companion=False):
    return np.array([numbers(hurst_exponent, member, companion)[name][row] for member in members])


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
    listed = runs(companions=2)
    xr.testing.assert_identical(made(listed), made(listed[::-1]))


def test_everything_has_units_and_a_long_name_and_the_study_is_stamped(runs):
    data = made(runs(companions=2), fit_limits=[1.0])
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
    data = made(runs(companions=2))
    for name in AVERAGED:
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
    data = made(runs(companions=2))
    for hurst_exponent in HURSTS:
        for row in range(3):
            fine, coarse = (
                by_hand("mean_gap", hurst_exponent, row, range(2), companion) for companion in (False, True)
            )
            found = data.mean_gap_grid_error.sel(hurst_exponent=hurst_exponent).isel(reduced_pressure=row).item()
            assert found == pytest.approx(abs(fine.mean() - coarse.mean()), rel=1e-12)


def test_a_member_unconverged_on_either_grid_is_left_out_of_the_grid_error(runs):
    data = made(runs(companions=3, bad={(0.2, 0, False, 0): MAX_ITERATIONS, (0.2, 2, True, 0): MAX_ITERATIONS}))
    expected = abs(by_hand("mean_gap", 0.2, 0, [1]) - by_hand("mean_gap", 0.2, 0, [1], True)).item()
    found = data.mean_gap_grid_error.sel(hurst_exponent=0.2).isel(reduced_pressure=0).item()
    assert found == pytest.approx(expected, rel=1e-12)
    assert unconverged(data) == (1, 24)  # of the study's own solutions


def test_without_a_companion_there_is_no_grid_error(runs):
    assert not [name for name in made(runs()).variables if str(name).endswith("_grid_error")]


# --- departures ---------------------------------------------------------------------------------------------------


def ensemble(values, bad=()):
    """A dataset of one quantity over (hurst_exponent, member, reduced_pressure), unconverged at the places in `bad`."""
    status = np.zeros(np.shape(values), np.int8)
    for place in bad:
        status[place] = MAX_ITERATIONS
    dims = ("hurst_exponent", "member", "reduced_pressure")
    coordinates = dict(zip(dims, (np.arange(n) / 10 for n in np.shape(values)), strict=True))
    return xr.Dataset({"kappa": (dims, values), "status": (dims, status)}, coordinates)


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


def bodies(values, bad=()):
    """The same with Poisson's ratios in place of Hurst exponents."""
    return ensemble(values, bad).rename(hurst_exponent="poisson_ratio")


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


# --- fits ---------------------------------------------------------------------------------------------------------

LOADS = np.geomspace(1e-3, 1, 12)
PLANTED = {0.2: (0.6, 1.3), 0.8: (0.9, 4.0)}


@pytest.mark.parametrize("weighting", WEIGHTINGS)
@pytest.mark.parametrize("planted", [*PLANTED.values(), (1.3, 0.5)])
def test_a_fit_recovers_the_planted_parameters(planted, weighting):
    area = np.tile(reference.line_area(LOADS, *planted), (2, 3, 1))
    # Convergence of least squares to 1e-8 of the cost, which is quadratic: half the digits of b2, the looser one.
    np.testing.assert_allclose(fit_line_area(LOADS, area, weighting), planted, rtol=1e-4)


def noisy(planted, members, size, seed):
    draw = np.random.default_rng(seed)
    clean = reference.line_area(LOADS, *planted)
    return clean * (1 + size * draw.standard_normal((1, members, LOADS.size)))


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_a_fit_of_noisy_areas_is_the_least_of_its_own_sum_of_squares(weighting):
    area = noisy(PLANTED[0.2], 3, 0.05, 0)

    def cost(b1, b2):
        model = reference.line_area(LOADS, b1, b2)
        return np.sum((model - area) ** 2 if weighting == "area" else np.log(model / area) ** 2)

    b1, b2 = fit_line_area(LOADS, area, weighting)
    for change in ((1.01, 1), (0.99, 1), (1, 1.02), (1, 0.98), (1.01, 1.02), (0.99, 0.98)):
        assert cost(b1, b2) < cost(b1 * change[0], b2 * change[1])


@pytest.mark.parametrize("weighting", WEIGHTINGS)
def test_a_fit_leaves_out_areas_that_are_not_known_or_zero(weighting):
    area = np.tile(reference.line_area(LOADS, *PLANTED[0.2]), (1, 3, 1))
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
    found = fits(line(), [1.0])
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
    found = fits(data, [0.9 * limit, limit])
    planted = np.array([[b1] * 2 for b1, _ in PLANTED.values()])
    below = found.fit_b1.isel(fitted=[0, 1], fit_limit=0).values
    # Up to 0.048 the area hardly depends on b2, so that b1 has fewer digits than in the fits above.
    np.testing.assert_allclose(below, planted, rtol=1e-3)
    assert (abs(found.fit_b1.isel(fitted=[0, 1], fit_limit=1).values / planted - 1) > 0.01).all()


def test_unconverged_areas_are_left_out_of_a_fit():
    data = line(bad=[(0, 1, 5)])
    data["relative_contact_area"][0, 1, 5] = 0.9
    np.testing.assert_allclose(fits(data, [1.0]).fit_b1.sel(fitted="0.2"), PLANTED[0.2][0], rtol=1e-4)


def test_a_hurst_exponent_that_never_converged_has_no_fit_and_spoils_no_other():
    found = fits(line(bad=[(0, slice(None), slice(None))]), [1.0])
    for name in ("fit_b1", "fit_b1_half_width"):
        assert np.isnan(found[name].sel(fitted="0.2")).all()
        assert np.isfinite(found[name].sel(fitted=["0.8", "all"])).all()
    np.testing.assert_allclose(found.fit_b1.sel(fitted="all"), PLANTED[0.8][0], rtol=1e-4)


def test_the_jackknife_of_a_mean_is_the_confidence_interval_of_a_mean(monkeypatch):
    mean = "contactsim.analysis.fits.fit_line_area"
    monkeypatch.setattr(mean, lambda pressure, area, weighting: (area.mean(), -2 * area.mean()))
    data = line(members=7, noise=0.1)
    found = fits(data, [1.0]).sel(fitted="0.8", weighting="area", fit_limit=1.0)
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
    one = fits(data, [1.0]).isel(fitted=0, fit_limit=0).sel(weighting="area")
    return one.fit_b1.item(), one.fit_b1_half_width.item()


def test_two_members_are_too_few_for_a_half_width():
    found = fits(line(members=2), [1.0])
    assert np.isnan(found.fit_b1_half_width).all()
    assert np.isfinite(found.fit_b1).all()


def test_a_study_with_fit_limits_gets_its_fits(runs):
    data = made(runs(), fit_limits=[0.2, 1.0])
    assert data.fit_b1.dims == ("fitted", "weighting", "fit_limit")
    assert data.fit_limit.values.tolist() == [0.2, 1.0]
    assert (data.fit_b1.units, data.fit_b1_half_width.units) == ("1", "1")
    assert "fit_b1" not in made(runs())


def test_an_aggregated_study_can_be_written_and_read(runs, tmp_path):
    data = made(runs(companions=2), fit_limits=[1.0])
    dataset.write(data, tmp_path / "study.nc")
    xr.testing.assert_identical(dataset.load_dataset(tmp_path / "study.nc"), data)


def test_a_load_is_named_by_the_dimension_that_it_is():
    for name in variables.LOADS:
        assert load_dimension(SimpleNamespace(dims=("member", name))) == name


def test_the_tolerance_error_is_the_change_on_solving_more_tightly_and_apart_from_the_grid_error(runs):
    listed = runs(companions=2)
    tight = [run | {"error": "tolerance"} for run in listed if run["measures_error"]]
    data = made([run for run in listed if not run["measures_error"]] + tight)
    assert "mean_gap_grid_error" not in data
    both = made(listed)
    assert np.array_equal(data.mean_gap_tolerance_error, both.mean_gap_grid_error)
    assert "solving more tightly" in data.mean_gap_tolerance_error.long_name
