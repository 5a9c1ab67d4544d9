"""Smooth laws on surfaces: the line as a surface, known answers of a sphere, equilibrium recomputed, two controls."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.analysis.aggregate import aggregate
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.grid import Grid
from contactsim.observables.derived import combine_runs, summarise_paths
from contactsim.observables.surface_adhesion import negative_area
from contactsim.paths.step_division import PATCH_COUNTERS
from contactsim.reference import adhesive_sphere
from contactsim.solvers.cohesive.long_waves import SurfaceWaves, node_averages
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.quantity_names import quantities
from contactsim.study.study import Study
from support.cases import orders, refused

MODULUS, WORK, RADIUS = 1.0, 1.0, 1000.0


def sphere_path(points, size, *, length=850.0, **options):
    """Press a sphere and pull it off, with a law by Maugis's parameter; lengths and forces over those of JKR."""
    strength = size / adhesive_sphere.maugis_parameter(WORK, RADIUS, MODULUS, 1.0)
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=WORK / (np.e * strength))
    scene = cs.Scene(
        cs.HalfSpace(MODULUS),
        cs.Sphere(radius=RADIUS, length=length),
        law,
        cs.approaches([-25.0, 10.0, -45.0], 1.0),
    )
    return cs.simulate(scene, points=points, **options)


def pull_off(data):
    """Return the largest pull, nN."""
    assert (data.status == 0).all()
    return -float(data.normal_force.min())


def test_a_line_stretched_to_a_surface_is_the_line():
    profile = cs.SelfAffine(256.0, 0.8, 128.0, 16.0, 0.2, seed=3).heights(64)
    law = cs.NormalCohesiveZone(work_of_separation=0.2, normal_length=1.0)
    path = cs.approaches([-4.0, 8.0, -6.0], 1.0, from_touch=True)
    line, surface = (
        cs.simulate(cs.Scene(cs.HalfSpace(2.0), cs.Topography(values, 4.0), law, path), tolerance=1e-8)
        for values in (profile, np.tile(profile, (4, 1)))
    )
    for name in ("mean_pressure", "mean_gap", "min_gap", "max_tensile_traction", "approach", "status"):
        assert surface[name].values == pytest.approx(line[name].values, rel=1e-6, abs=1e-8), name
    assert surface.normal_force.values == pytest.approx(16.0 * line.line_load.values, rel=1e-6, abs=1e-7)
    assert surface.contact_area.values == pytest.approx(16.0 * line.contact_length.values, rel=1e-5, abs=16.0 * 4.0)


def test_paths_of_a_stretched_line_are_summarised_alike():
    profile = cs.SelfAffine(256.0, 0.8, 128.0, 16.0, 0.2, seed=3).heights(64)
    law = cs.NormalCohesiveZone(work_of_separation=2.0, normal_length=1.0)
    path = cs.approaches([-12.0, 6.0, -20.0], 0.5, from_touch=True)
    line, surface = (
        summarise_paths(combine_runs([(data.drop_vars("seconds"), {"member": 0})])).isel(member=0)
        for data in (
            cs.simulate(cs.Scene(cs.HalfSpace(20.0), cs.Topography(values, 4.0), law, path), tolerance=1e-7)
            for values in (profile, np.tile(profile, (4, 1)))
        )
    )
    for leg in ("loading", "unloading"):
        assert float(line[f"pull_off_load_{leg}"]) > 0
        assert float(surface[f"pull_off_force_{leg}"]) == pytest.approx(
            16.0 * float(line[f"pull_off_load_{leg}"]), rel=1e-5
        )
        assert float(surface[f"pull_off_approach_{leg}"]) == pytest.approx(
            float(line[f"pull_off_approach_{leg}"]), abs=1e-5
        )
    assert float(surface.dissipated_work) == pytest.approx(float(line.dissipated_work), rel=1e-3, abs=1e-6)
    for name in ("area_at_12nm", "pressure_at_area_0_1", "curvature", "gradient_ratio_at_area_0_02"):
        assert float(surface[name]) == pytest.approx(float(line[name]), rel=1e-5, nan_ok=True), name
    assert not {"dissipated_energy", "pull_off_load_loading", "peak_displacement"} & set(surface)


STUDY = {
    "title": "Rough surface",
    "surface": {
        **{"kind": "self_affine", "dimensions": 2, "hurst_exponent": 0.8, "length": 64.0, "rms_height": 1.0},
        **{"long_cutoff": 32.0, "short_cutoff": 8.0},
    },
    "body": {"kind": "half_space", "youngs_modulus": 1.0, "poisson_ratio": 0.3},
    "effects": ["normal_cohesive_zone"],
    "normal_cohesive_zone": {"work_of_separation": 0.1, "normal_length": 0.5},
    "path": {"approach": [-9.0, 0.0, -12.0], "increment": 0.5},
    "points": 32,
    "members": 2,
    "coarse_grid": {"points": 16, "members": 2},
    "tolerance": 1e-5,
}


def test_a_study_of_surfaces_has_means_errors_and_summaries(tmp_path):
    study = Study.read("rough", STUDY, "ch9.yaml", 1)
    runs = []
    for run in study.runs():
        files = RunFiles(tmp_path / f"{run.variant}{run.member}.nc", tmp_path / f"{run.variant}{run.member}.json")
        execute.run(run.settings, "source", files)
        own = {"path": files.data, "coordinates": run.coordinates, "member": run.member, "error": "grid"}
        runs.append(own | {"measures_error": bool(run.error)})
    data = aggregate(runs, study.settings, "source")
    assert set(quantities(study)) - {"step"} <= set(data) | {"area_at_12nm_error_bar", "area_at_20nm_error_bar"} | {
        f"{name}_error_bar_grid_error" for name in ("area_at_12nm", "area_at_20nm")
    }
    for name in ("pull_off_force_unloading", "dissipated_work", "final_contact_area"):
        assert np.isfinite(data[name]).all(), name
        assert np.isfinite(data[f"{name}_grid_error"]).all(), name
    assert np.isfinite(data.dissipated_work_increment_error).all()
    assert (data.relative_repulsive_area_standard_error.max() > 0).all()


def test_a_study_of_shear_on_surfaces_is_refused_before_it_runs():
    law = {"work_of_separation": 0.1, "work_ratio": 1.0, "normal_length": 0.5, "tangential_length": 0.5}
    section = {key: value for key, value in STUDY.items() if key != "normal_cohesive_zone"}
    with refused("studies.rough.effects", "surfaces are not modelled"):
        Study.read("rough", section | {"effects": ["cohesive_zone"], "cohesive_zone": law}, "ch9.yaml", 1)


def test_patches_of_a_surface_are_areas():
    rows, columns = np.indices((32, 32)) - 16
    distance = np.hypot(rows, columns)
    ring = (distance > 9) & (distance < 11)
    assert PATCH_COUNTERS[2](ring) == 1
    assert PATCH_COUNTERS[2](ring | (distance < 4)) == 2
    assert PATCH_COUNTERS[1](ring[16]) == 2


def test_a_stiff_sphere_pulls_as_a_rigid_one():
    """Bradley and DMT: 2πwR whatever the law; Maugis's parameter is 0.04."""
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=1.0)
    scene = cs.Scene(cs.HalfSpace(1000.0), cs.Sphere(radius=RADIUS, length=400.0), law, cs.approaches([-3.0, 0.0], 0.1))
    data = cs.simulate(scene, points=64)
    assert pull_off(data) == pytest.approx(adhesive_sphere.dmt_pull_off(WORK, RADIUS), rel=0.02)


def test_between_dmt_and_jkr_the_pull_off_is_near_that_of_maugis_and_does_not_depend_on_the_grid():
    coarse, fine = (pull_off(sphere_path(points, 1.0)) for points in (64, 128))
    strength = 1.0 / adhesive_sphere.maugis_parameter(WORK, RADIUS, MODULUS, 1.0)
    maugis = adhesive_sphere.maugis_pull_off(WORK, RADIUS, MODULUS, strength)
    assert fine == pytest.approx(coarse, rel=1e-3)
    assert maugis < fine < 1.06 * maugis  # the law's tail is longer than Dugdale's
    assert fine < adhesive_sphere.dmt_pull_off(WORK, RADIUS)


def test_a_soft_sphere_jumps_both_ways_and_dissipates():
    data = sphere_path(128, 2.0)
    loading = np.arange(data.step.size) < 35
    jumps = data.jump.values > 0
    assert jumps[loading].any()
    assert jumps[~loading].any()
    pressed, pulled = data.normal_force.values[:34], data.normal_force.values[35:69][::-1]
    assert data.approach.values[:34] == pytest.approx(data.approach.values[35:69][::-1])
    assert (pulled - pressed).sum() < 0  # the same approaches, with more pull on the way back
    assert {"fold_force_before", "fold_force_after"} <= set(data)


@pytest.mark.parametrize("shape", [(32, 48), (27, 40)])
def test_the_stored_state_is_in_equilibrium_by_equations_written_once_more(shape):
    heights = np.random.default_rng(2).normal(size=shape)
    spectrum = np.fft.rfft2(heights)
    waves = np.fft.fftfreq(shape[0])[:, None] ** 2 + np.fft.rfftfreq(shape[1]) ** 2
    heights = np.fft.irfft2(spectrum * np.exp(-600 * waves), shape)
    heights *= 2.0 / np.ptp(heights)
    law = cs.NormalCohesiveZone(work_of_separation=0.5, normal_length=1.0)
    topography = cs.Topography(heights, (3.0, 2.0))
    scene = cs.Scene(cs.HalfSpace(3.0), topography, law, cs.approaches([-1.0, 1.0], 0.5))
    data = cs.simulate(scene, tolerance=1e-9, snapshots=[1.0])
    state = data.isel(snapshot=-1)
    gap, traction = state.normal_gap.values, state.normal_traction.values
    assert gap.shape == shape
    assert np.allclose(traction, 0.5 * gap * np.exp(-gap), rtol=1e-9)
    q = 2 * np.pi * np.hypot(np.fft.fftfreq(shape[0], 3.0)[:, None], np.fft.rfftfreq(shape[1], 2.0))
    pressure = np.fft.rfft2(-traction)
    displacement = np.fft.irfft2(np.divide(2 * pressure, 3.0 * q, out=0 * pressure, where=q > 0), shape)
    assert gap == pytest.approx(displacement - heights - 1.0, abs=1e-7)


def test_the_load_of_an_approach_leads_back_to_it():
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=5.0)
    body, sphere = cs.Layer(MODULUS, 0.3, 500.0), cs.Sphere(radius=RADIUS, length=850.0)
    first = cs.simulate(cs.Scene(body, sphere, law, cs.approaches([-20.0, 20.0], 4.0)), points=64, tolerance=1e-8)
    loads = first.mean_pressure.values[6:].tolist()
    assert min(np.diff(loads)) > 0
    second = cs.simulate(cs.Scene(body, sphere, law, cs.pressures(loads)), points=64, tolerance=1e-8)
    assert second.approach.values == pytest.approx(first.approach.values[6:], abs=1e-4)
    assert second.contact_area.values == pytest.approx(first.contact_area.values[6:], rel=1e-4)


def test_the_area_of_a_disc_is_found_to_second_order():
    rng, errors = np.random.default_rng(0), []
    for points in (32, 64, 128):
        areas = []
        for shift in rng.uniform(0, 1, (40, 2)):
            y, x = ((np.arange(points) + part) * 4 / points - 2 for part in shift)
            areas.append(negative_area(y[:, None] ** 2 + x**2 - 1, (4 / points, 4 / points)))
        errors.append(np.sqrt(np.mean((np.array(areas) / np.pi - 1) ** 2)))
    assert errors[0] < 0.01
    assert np.mean(orders(errors)) > 1.7


def test_long_waves_of_a_surface_are_those_that_nodes_carry():
    grid = Grid((24, 40), (3.0, 5.0))
    waves = SurfaceWaves(grid, 4)
    y, x = 2 * np.pi * np.arange(24)[:, None] / 24, 2 * np.pi * np.arange(40) / 40
    long = np.cos(2 * y + 0.3) * np.sin(3 * x) + 0.7
    half = grid.forward_rows(long.reshape(1, -1))
    assert np.abs(half[:, waves.high]).max() < 1e-15
    nodes = waves.field(half[:, waves.low])
    assert nodes == pytest.approx(long[::4, ::4].reshape(1, -1))
    assert waves.coefficients(nodes) == pytest.approx(half[:, waves.low])
    assert node_averages(np.ones((1, 960)), grid, 4) == pytest.approx(np.ones((1, 60)))


def test_what_surfaces_do_not_have_is_refused():
    sheared = cs.CohesiveZone(work_of_separation=WORK, work_ratio=1.0, normal_length=5.0, tangential_length=5.0)
    body = cs.HalfSpace(MODULUS, 0.3)
    with refused("effects", "surfaces are not modelled"):
        path = cs.approaches([-4.0, 4.0], 1.0)
        cs.simulate(cs.Scene(body, cs.Sphere(radius=RADIUS, length=850.0), sheared, path), points=64)


def test_only_the_normal_component_exists():
    law = cs.NormalCohesiveZone(work_of_separation=WORK, normal_length=5.0)
    sphere = cs.Sphere(radius=RADIUS, length=850.0)
    scene = cs.Scene(cs.HalfSpace(MODULUS), sphere, law, cs.approaches([-4.0, 4.0], 1.0))
    problem = pose_cohesive(scene, scene.heights(16), 1e-4)
    assert problem.unknowns == (1, 16 * 9)
    assert problem.shape.shape == (1, 256)
    assert problem.slip_factor is None
