"""A study becomes runs: variants, members and error runs; their settings, digests, surfaces and loads."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from contactsim import dataset
from contactsim.analysis import aggregate
from contactsim.provenance import canonical
from contactsim.study.quantity_names import quantities
from contactsim.study.scenes import build_scene
from contactsim.study.study import Study
from contactsim.variables import ERRORS, dimension_name
from support.rough_study import GONE, WALKED, changed, executed, profile, refusal, smooth, study

SECOND = {"kind": "half_space", "contact_modulus": 3.0}


@pytest.mark.parametrize(
    "vary",
    [
        {"surface.long_cutoff": [16.0, 32.0]},
        {"surface.length": [64.0, 128.0]},
        {"surface.amplitudes": ["gaussian", "fixed"]},
        {"body.contact_modulus": [1.0, 2.0]},
        {"solver.kind": ["active_set", "polonsky_keer"]},
    ],
    ids=lambda vary: next(iter(vary)),
)
def test_what_may_be_varied_can_also_be_aggregated(vary, tmp_path):
    section = {"vary": vary, "members": 1, "coarse_grid": GONE, "load": {"reduced_pressure": [0.1]}}
    read = study(section)
    data = aggregate.aggregate(executed(read, tmp_path), read.settings, "source")
    ((name, values),) = vary.items()
    assert sorted(data.indexes[dimension_name(name)]) == sorted(values)


def test_the_kinds_of_two_sections_are_varied_along_two_dimensions():
    vary = {"surface.kind": ["flat"], "solver.kind": ["active_set", "polonsky_keer"]}
    runs = smooth("flat", {"mean_pressure": [0.1]}, vary=vary).runs()
    assert [len(run.coordinates) for run in runs] == [2, 2]


@pytest.fixture
def scan(tmp_path):
    path = tmp_path / "scan.csv"
    np.savetxt(path, np.random.default_rng(0).standard_normal(20))
    return path


def measured_section(file):
    surface = {"kind": "measured", "file": str(file), "spacing": 1.0, "unit": "nm"}
    load = {"mean_pressure": [1e-3]}
    return {"surface": surface, "load": load, "vary": {}, "points": GONE, "coarse_grid": GONE, "members": 1}


def test_a_measured_surface_brings_its_own_points(scan):
    (run,) = study(measured_section(scan)).runs()
    assert run.settings["points"] is None
    assert profile(run).size == 38  # mirrored: twice 20 less the two ends


def test_a_measured_file_that_is_missing_is_named(tmp_path):
    error = refusal(measured_section(tmp_path / "none.csv"))
    assert (error.file, error.key) == ("ch9.yaml", "studies.rough.surface.file")
    assert error.value == str(tmp_path / "none.csv")
    assert "file that can be read" in error.allowed


def test_a_folder_for_a_measured_file_is_refused(tmp_path):
    assert str(tmp_path) in str(refusal(measured_section(tmp_path)))


def test_a_measured_file_that_changes_makes_another_run(scan):
    section = measured_section(scan)
    before = study(section).runs()[0]
    scan.write_text(scan.read_text() + "1.0\n")
    assert study(section).runs()[0].digest != before.digest
    assert study(section).runs()[0].stem == before.stem


def test_a_measured_file_with_a_number_missing_is_refused_with_the_row(scan):
    scan.write_text("1.0\nnan\n2.0\n")
    error = refusal(measured_section(scan))
    assert (str(error.file), error.key) == (str(scan), "studies.rough.heights")
    assert "nan in row 2" in error.value
    assert "finite numbers" in error.allowed


def test_a_measured_surface_refuses_another_number_of_points(scan):
    error = refusal(measured_section(scan) | {"points": 64})
    assert (error.key, error.value) == ("studies.rough.points", 64)
    assert "38" in error.allowed


def test_a_measured_surface_has_no_coarse_run(scan):
    error = refusal(measured_section(scan) | {"coarse_grid": {"points": 19, "members": 1}})
    assert error.key == "studies.rough.coarse_grid.points"


# --- runs ---------------------------------------------------------------------------------------------------------


def test_there_is_one_run_per_variant_and_member_and_coarse_runs_come_last():
    runs = study().runs()
    assert [run.measures_error for run in runs] == [False] * 12 + [True] * 6
    places = [(run.coordinates["hurst_exponent"], run.coordinates["long_cutoff"], run.member) for run in runs]
    values = [0.2, 0.8], [16.0, 24.0, 32.0]
    assert places[:12] == list(itertools.product(*values, [0, 1]))
    assert places[12:] == list(itertools.product(*values, [0]))
    assert {run.settings["points"] for run in runs[:12]} == {128}
    assert {run.settings["points"] for run in runs[12:]} == {64}


def test_a_run_has_the_varied_values_in_its_settings():
    for run in study().runs():
        assert run.settings["surface"]["hurst_exponent"] == run.coordinates["hurst_exponent"]
        assert run.settings["surface"]["long_cutoff"] == run.coordinates["long_cutoff"]
        assert run.settings["member"] == run.member


def test_settings_hold_what_a_run_depends_on_and_nothing_else():
    run = study({"title": "Another title", "thesis_points": 999}).runs()[0]
    assert set(run.settings) == {
        *("study", "member", "seed", "points", "effects", "load", "tolerance", "keep"),
        *("surface", "body", "solver"),
    }
    assert canonical(run.settings) == canonical(study().runs()[0].settings)


def test_a_solver_that_is_not_named_is_the_usual_one_of_the_dimension():
    assert study({"solver": {"budget": 5}}).runs()[0].settings["solver"]["kind"] == "active_set"
    surface = study({"surface/dimensions": 2, "solver": {"budget": 5}})
    assert surface.runs()[0].settings["solver"]["kind"] == "conjugate_gradients"


def test_defaults_stand_in_the_settings_as_if_they_were_given():
    given = {"surface/amplitudes": "gaussian", "solver": {"kind": "active_set", "budget": 200}}
    assert canonical(study(given).runs()[0].settings) == canonical(study().runs()[0].settings)


def test_no_two_runs_share_a_file_or_their_settings():
    runs = study().runs()
    assert len({run.stem for run in runs}) == len({canonical(run.settings) for run in runs}) == len(runs)


def by_place(runs):
    return {(*sorted(run.coordinates.items()), run.member, run.measures_error): run for run in runs}


def test_the_order_of_varied_keys_and_values_changes_no_run():
    turned = study({"vary": {"surface.long_cutoff": [32.0, 16.0, 24.0], "surface.hurst_exponent": [0.8, 0.2]}})
    one, other = by_place(study().runs()), by_place(turned.runs())
    assert one.keys() == other.keys()
    for place, run in one.items():
        assert run.stem == other[place].stem
        assert canonical(run.settings) == canonical(other[place].settings)


def test_a_variant_and_a_member_do_not_depend_on_the_others():
    more = study({"vary": {"surface.hurst_exponent": [0.2, 0.5, 0.8], "surface.long_cutoff": [24.0]}, "members": 5})
    one, other = by_place(study().runs()), by_place(more.runs())
    common = one.keys() & other.keys()
    assert len(common) == 6  # two Hurst exponents at one roll-off: two members each, and a coarse run
    for place in common:
        assert one[place].stem == other[place].stem
        assert canonical(one[place].settings) == canonical(other[place].settings)


def test_settings_are_the_same_for_reordered_keys():
    section = changed({})
    turned = {
        name: dict(reversed(value.items())) if isinstance(value, dict) else value for name, value in section.items()
    }
    turned = Study.read("rough", dict(reversed(turned.items())), "ch9.yaml", 1)
    for one, other in zip(study().runs(), turned.runs(), strict=True):
        assert (one.stem, one.digest) == (other.stem, other.digest)


def test_loads_are_sorted_so_that_their_order_changes_nothing():
    one, other = study(), study({"load": {"reduced_pressure": [0.01, 0.1]}})
    assert one.settings["load"] == {"name": "reduced_pressure", "values": [0.01, 0.1]}
    assert one.runs()[0].digest == other.runs()[0].digest


@pytest.mark.parametrize(
    "changes",
    [
        {"load": {"reduced_pressure": [0.01, 0.1, 0.2]}},
        {"load": {"mean_pressure": [0.01, 0.1]}},
        {"points": 256},
        {"tolerance": 1e-4},
        {"body/contact_modulus": 1.0},
        {"surface/short_cutoff": 4.1},
        {"surface/amplitudes": "fixed"},
        {"solver": {"kind": "polonsky_keer"}},
        {"solver": {"kind": "active_set", "reduction": 0.05}},
    ],
)
def test_a_run_has_another_digest_when_anything_it_depends_on_changes(changes):
    digests = [read.runs()[0].digest for read in (study(), study(changes), study(seed=2), study(changes, seed=2))]
    assert len(set(digests)) == 4


# --- surfaces and loads -------------------------------------------------------------------------------------------


def test_the_same_seed_study_hurst_and_member_give_the_same_profile_whatever_else_changes():
    one = study().runs()[0]
    others = [
        study({"members": 7, "coarse_grid": GONE}).runs()[0],
        study({"load": {"mean_pressure": [0.5]}, "body/contact_modulus": 3.0, "tolerance": 1e-5}).runs()[0],
        study({"solver": {"kind": "verlet"}, "title": "other"}).runs()[0],
        study({"vary": {"surface.hurst_exponent": [0.2]}, "surface/long_cutoff": 16.0}).runs()[0],
    ]
    for other in others:
        assert np.array_equal(profile(one), profile(other))


def test_members_hurst_exponents_studies_and_seeds_are_independent_draws():
    def phases(run):
        return np.angle(run.setup.scene.upper.surface.coefficients[1:])

    low, high = (
        study({"vary": {"surface.hurst_exponent": [hurst_exponent]}, "coarse_grid": GONE})
        for hurst_exponent in (0.2, 0.8)
    )
    renamed = Study.read("other", changed({"vary": {"surface.hurst_exponent": [0.2]}}), "ch9.yaml", 1)
    seeded = study({"vary": {"surface.hurst_exponent": [0.2]}}, seed=2)
    runs = [*low.runs(), *high.runs(), renamed.runs()[0], seeded.runs()[0]]
    drawn = [phases(run) for run in runs]
    for one, other in itertools.combinations(drawn, 2):
        assert not np.isclose(one, other, rtol=0, atol=1e-6).any()  # 15 pairs each: chance 3e-7 a pair to be so near


def test_a_coarse_run_samples_the_same_surface():
    runs = by_place(study().runs())
    for (*place, member, measures_error), run in runs.items():
        if measures_error:
            fine, coarse = profile(runs[(*place, member, False)]), profile(run)
            # Both are sums of the same waves: they differ by the rounding of two transforms only.
            assert np.allclose(fine[::2], coarse, rtol=0, atol=1e-14 * np.abs(fine).max() * np.log2(fine.size))


def pressures(run):
    return np.array([step.value for step in run.setup.scene.path.steps])


def test_reduced_pressures_are_times_modulus_and_the_gradient_asked_for():
    for run in study({"vary": {"surface.rms_gradient": [0.01, 0.02]}}).runs():
        expected = np.array([0.01, 0.1]) * 2.0 * run.settings["surface"]["rms_gradient"]
        np.testing.assert_allclose(pressures(run), expected, rtol=1e-15)


def test_reduced_pressures_of_prescribed_heights_use_each_members_own_gradient_whatever_the_grid():
    runs = study({"surface/rms_gradient": GONE, "surface/rms_height": 3.0}).runs()
    places = {}
    for run in runs:
        surface = run.setup.scene.upper.surface
        np.testing.assert_allclose(
            pressures(run), np.array([0.01, 0.1]) * 2.0 * surface.profile_rms_gradient, rtol=1e-15
        )
        places.setdefault((*run.coordinates.values(), run.member), []).append(pressures(run).tolist())
    assert all(loads == [loads[0]] * len(loads) for loads in places.values())  # of a run and its coarse run
    assert len({tuple(loads[0]) for loads in places.values()}) == len(places)


def test_a_varied_height_has_a_dimension_beside_the_height_found():
    height = {"surface/rms_gradient": GONE, "vary": {"surface.rms_height": [10.0, 30.0]}, "coarse_grid": GONE}
    varied = study(height | {"surface/rms_height": 10.0})
    assert varied.dimensions == ["surface_rms_height", "member", "reduced_pressure"]
    first, *_, last = varied.runs()
    ten, thirty = (build_scene(run.settings | {"member": 0}).heights(128) for run in (first, last))
    assert np.allclose(thirty, 3 * ten, rtol=1e-12)  # the same profile, so that its contact is an identity


def test_reduced_pressures_without_a_prescribed_gradient_use_that_of_the_heights():
    (run,) = smooth("sinusoid", {"reduced_pressure": [0.1]}, points=1024).runs()
    exact = 2 * np.pi * 2 * 1.0 / 64.0 / np.sqrt(2)  # rms slope of a wave: its wavenumber times amplitude/√2
    # Differences over a step d make the gradient sin(x)/x with x = qd/2 = 6e-3: smaller by x²/6 = 6e-6.
    np.testing.assert_allclose(pressures(run), 0.1 * 2.0 * exact, rtol=1e-5)


def test_mean_pressures_are_taken_as_they_are():
    (run,) = smooth("flat", {"mean_pressure": [0.3, 0.1]}).runs()
    assert pressures(run).tolist() == [0.1, 0.3]
    assert (run.coordinates, run.member) == ({}, 0)  # nothing is varied


@pytest.mark.parametrize(
    ("bodies", "modulus"),
    [({}, 2.0), ({"counter_body": SECOND}, 1.2), ({"body": {"kind": "rigid"}, "counter_body": SECOND}, 3.0)],
)
def test_a_reduced_pressure_on_two_bodies_is_counted_by_the_modulus_of_both(bodies, modulus):
    run = study(bodies).runs()[0]
    np.testing.assert_allclose(pressures(run), np.array([0.01, 0.1]) * modulus * 0.01, rtol=1e-12)


def test_only_errors_that_a_study_measures_are_quantities():
    tight = {"tight_tolerance": {"tolerance": 1e-4, "members": 1}}
    for changes, measured in (({}, {"grid"}), ({"coarse_grid": GONE}, set()), (tight, {"grid", "tolerance"})):
        names = quantities(study(changes))
        assert {kind for kind in ERRORS if f"kappa_{kind}_error" in names} == measured


def test_contact_ratios_are_turned_into_hertzian_loads():
    (run,) = smooth("cylinder", {"contact_ratio": [0.1]}).runs()
    hertz = np.pi * 2.0 * 10.0**2 / (4 * 100.0)  # π E* c²/4R per unit thickness
    np.testing.assert_allclose(pressures(run), hertz / 64.0, rtol=1e-14)


def test_tight_runs_come_after_all_others_and_differ_in_the_tolerance_alone():
    runs = study({"tight_tolerance": {"tolerance": 1e-9, "members": 1}}).runs()
    tight = [run for run in runs if run.error == "tolerance"]
    assert runs[-len(tight) :] == tight
    assert all(run.measures_error for run in tight)
    for run in tight:
        (same,) = (
            other
            for other in runs
            if not other.measures_error and (other.coordinates, other.member) == (run.coordinates, run.member)
        )
        assert run.settings == same.settings | {"tolerance": 1e-9}
        assert run.variant != same.variant


@pytest.mark.parametrize(
    ("tight", "key", "allowed"),
    [
        ({"tolerance": 1.0, "members": 1}, "tolerance", "below the study's tolerance"),
        ({"tolerance": 1e-9, "members": 9}, "members", "at most 2"),
        ({"tolerance": 1e-9}, "members", "missing"),
        ({"tolerance": 1e-9, "members": 1, "points": 8}, "points", "no such key"),
    ],
)
def test_a_bad_run_of_tight_tolerance_is_refused(tight, key, allowed):
    error = refusal({"tight_tolerance": tight})
    assert error.key == f"studies.rough.tight_tolerance.{key}"
    assert allowed in error.allowed


# --- grids and surfaces in common ---------------------------------------------------------------------------------


FINER = {"points": GONE, "coarse_grid": GONE, "vary": {"points": [64, 128, 256], "surface.hurst_exponent": [0.2]}}


def test_varied_points_are_a_dimension_and_sample_the_same_surface():
    one = study(FINER)
    assert one.dimensions == ["points", "hurst_exponent", "member", "reduced_pressure"]
    runs = [run for run in one.runs() if run.member == 1]
    assert [run.coordinates["points"] for run in runs] == [run.settings["points"] for run in runs] == [64, 128, 256]
    assert not any(run.measures_error for run in runs)
    coarse, *_, fine = (profile(run) for run in runs)
    assert np.allclose(fine[::4], coarse, rtol=0, atol=1e-14 * np.abs(fine).max() * np.log2(fine.size))


def test_a_run_on_a_varied_grid_is_that_of_a_study_with_this_grid():
    alone = study({"points": 64, "coarse_grid": GONE, "vary": {"surface.hurst_exponent": [0.2]}}).runs()[0]
    assert canonical(study(FINER).runs()[0].settings) == canonical(alone.settings)


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        ({"points": 128}, "points", "left out, for points are varied"),
        ({"coarse_grid": {"points": 32, "members": 1}}, "coarse_grid", "left out, for points are varied"),
        ({"vary": {"points": [64, 1]}}, "vary.points", "2 or more"),
        ({"vary": {"points": [64.5]}}, "vary.points", "a whole number"),
        ({"vary": {"points": [16]}}, "points", "two points per shortest wavelength"),
    ],
)
def test_grids_that_cannot_be_varied_are_refused(changes, key, allowed):
    error = refusal(FINER | changes)
    assert error.key == f"studies.rough.{key}"
    assert allowed in error.allowed


def test_a_study_may_press_the_surfaces_of_another():
    own, same = study().runs(), Study.read("other", changed({"same_surfaces_as": "rough"}), "ch9.yaml", 1).runs()
    for one, other in zip(own, same, strict=True):
        assert one.stem != other.stem
        assert np.array_equal(profile(one), profile(other))


def test_grids_are_aggregated_along_points_with_their_limit(tmp_path):
    read = study(FINER)
    runs = executed(read, tmp_path)
    data = aggregate.aggregate(runs, read.settings, "source")
    assert data.points.values.tolist() == [64, 128, 256]
    assert data.kappa_mean.dims == ("points", "hurst_exponent", "reduced_pressure")
    assert data.kappa_limit.dims == ("hurst_exponent", "reduced_pressure")
    assert data.kappa_limit.attrs["long_name"].endswith("extrapolated to the limit on finer grids")
    two = aggregate.aggregate([run for run in runs if run["coordinates"]["points"] != 64], read.settings, "source")
    assert "kappa_limit" not in two


def test_states_of_paths_are_averaged_over_members_with_the_error_of_the_grid(tmp_path):
    section = WALKED | {
        "vary": GONE,
        "members": 2,
        "points": 256,
        "coarse_grid": {"points": 128, "members": 1},
        "snapshots": [-4.0],
        "snapshot_members": 1,
        "tolerance": 1e-6,
    }
    read = study(section)
    runs = executed(read, tmp_path)
    assert ["normal_gap" in dataset.load_dataset(run["path"]) for run in runs[:2]] == [True, False]
    data = aggregate.aggregate(runs, read.settings, "source")
    one, two = data.mean_pressure.transpose("member", "step").values
    assert np.allclose(data.mean_pressure_mean, (one + two) / 2)
    assert np.allclose(data.mean_pressure_standard_error, np.abs(one - two) / 2)
    coarse = dataset.load_dataset(runs[2]["path"]).mean_pressure.values
    assert np.allclose(data.mean_pressure_grid_error, np.abs(one - coarse))
    assert np.allclose(data.normalised_pressure_mean, data.mean_pressure_mean / data.contact_modulus)
    assert np.allclose(data.relative_repulsive_area, data.contact_length / data.length)
    assert data.gradient_ratio_interacting_mean.dims == ("step",)
