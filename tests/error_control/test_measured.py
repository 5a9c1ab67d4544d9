"""Accuracy and cost of measured heights: the error is what every second point changes."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.error_control.control import solve_to_error
from contactsim.error_control.forecast import describe_forecasts, forecast_run
from contactsim.paths.options import Accuracy, RunOptions, Setup
from contactsim.study.study import Study
from support.cases import refused


def heights(points, short=8.0, dimensions=1):
    """Return a rough line or surface whose shortest wavelength is 8 nm."""
    return cs.SelfAffine(512.0, 0.8, 256.0, short, 0.3, dimensions=dimensions, seed=5).heights(points)


def scene_of(values, body=None, loads=(0.01, 0.1)):
    """Return measured heights, 512 nm long, under loads."""
    topography = cs.Topography(values, 512.0 / values.shape[-1])
    return cs.Scene(body or cs.HalfSpace(1.0), topography, cs.HardWall(), cs.pressures(loads))


@pytest.mark.parametrize("body", [cs.HalfSpace(1.0), cs.FreeHalfSpace(1.0)])
def test_the_error_is_the_change_on_every_second_point(body):
    values = heights(512)
    data = cs.simulate(scene_of(values, body), accuracy=0.05)
    name = "relative_contact_area_subgrid"
    coarse = cs.simulate(scene_of(values[::2], body), tolerance=1e-4)
    assert data.points.item() == 512
    assert data[f"{name}_estimated_error"].values == pytest.approx(np.abs(data[name] - coarse[name]).values, rel=1e-6)
    relative = data[f"{name}_estimated_error"] / data[name]
    assert data.accuracy_reached.item() == int((relative <= 0.05).all())


def test_a_fine_scan_reaches_an_accuracy_that_a_coarse_one_says_it_does_not():
    fine, coarse = (cs.simulate(scene_of(heights(points), loads=[0.1]), accuracy=0.02) for points in (8192, 128 + 16))
    assert fine.accuracy_reached.item() == 1
    assert coarse.accuracy_reached.item() == 0
    truth = fine.relative_contact_area_subgrid.item()
    error = coarse.relative_contact_area_subgrid_estimated_error.item()
    assert abs(coarse.relative_contact_area_subgrid.item() - truth) < 2 * error


def test_any_number_of_each_load_can_be_asked_for():
    data = cs.simulate(scene_of(heights(256)), accuracy=0.1, quantities=["mean_gap", "max_pressure"])
    assert {"mean_gap_estimated_error", "max_pressure_estimated_error"} <= set(data)
    assert "relative_contact_area_subgrid_estimated_error" not in data
    for name in ("pull_off_load", "seconds", "status"):
        with refused("quantities", "mean_gap"):
            cs.simulate(scene_of(heights(256)), accuracy=0.1, quantities=[name])
    with refused("quantities", "where `keep` has it"):
        cs.simulate(scene_of(heights(256)), accuracy=0.1, quantities=["contact_stiffness"])
    kept = cs.simulate(scene_of(heights(256)), accuracy=0.1, quantities=["contact_stiffness"], keep=["stiffness"])
    assert "contact_stiffness_estimated_error" in kept


def test_its_cost_is_foreseen_within_a_factor():
    for scene in (scene_of(heights(1024)), scene_of(heights(128, 16.0, 2), cs.FreeHalfSpace(1.0))):
        forecast = cs.estimate_cost(scene, accuracy=0.05)
        data = cs.simulate(scene, accuracy=0.05)
        work = data.transforms.sum().item() + data.coarse_run_transforms.item()
        assert 0.15 < work / forecast.transforms < 4
        assert all(np.isnan(error) for error in forecast.errors.values())
        assert forecast.points == data.points.item()


def test_of_an_odd_number_of_points_the_error_is_that_of_the_even_part():
    """Hertz on 65 points: the coarser grid has the length of 64, and the error is not that of another length."""
    x = (np.arange(65) - 32) / 16
    scene = cs.Scene(
        cs.FreeHalfSpace(1.0),
        cs.Topography(-(x[:, None] ** 2 + x**2) / 2, 1 / 16),
        cs.HardWall(),
        cs.pressures([4 / 3 / (65 / 16) ** 2]),
    )
    data = cs.simulate(scene, accuracy=0.1, quantities=["approach", "relative_contact_area_subgrid"])
    assert data.points.item() == 65
    assert data.coarse_run_points.item() == 32
    assert data.refinements.item() == 0
    assert data.approach.item() == pytest.approx(1, abs=1e-3)
    assert data.approach_estimated_error.item() < 4e-3


def test_the_lower_body_may_be_the_measured_one():
    values = heights(256)
    topography = cs.Topography(values, 2.0)
    up, down = (
        cs.simulate(cs.Scene(*bodies, cs.HardWall(), cs.pressures([0.05])), accuracy=0.5)
        for bodies in (
            (cs.Body(cs.Flat(512.0), cs.HalfSpace(1.0)), cs.Body(topography)),
            (cs.Body(topography, cs.HalfSpace(1.0)), cs.Body(cs.Flat(512.0))),
        )
    )
    name = "relative_contact_area_subgrid"
    assert down[name].item() == up[name].item()
    assert down[f"{name}_estimated_error"].item() == up[f"{name}_estimated_error"].item()


def test_a_study_of_a_file_has_an_accuracy_and_reduced_pressures_of_its_own_gradient(tmp_path):
    np.save(tmp_path / "scan.npy", np.cumsum(np.random.default_rng(1).normal(size=256)))
    section = {
        "title": "Scan",
        "surface": {"kind": "measured", "file": str(tmp_path / "scan.npy"), "spacing": 2.0, "ends": "none"},
        "body": {"kind": "free_half_space", "contact_modulus": 1.0},
        "effects": ["hard_wall"],
        "load": {"reduced_pressure": [0.01]},
        "accuracy": 0.5,
    }
    (run,) = Study.read("scan", section, "ch3.yaml", 1).runs()
    data = solve_to_error(run.setup, 0.5).data
    assert data.points.item() == 256
    assert data.mean_pressure.item() == pytest.approx(0.01 * data.rms_gradient.item())
    assert "relative_contact_area_subgrid_estimated_error" in data


def test_what_has_no_coarser_grid_or_no_relations_is_refused():
    with refused("surface", "8 points or more each way"):
        cs.simulate(scene_of(heights(257)[:6], cs.FreeHalfSpace(1.0)), accuracy=0.1)
    law = cs.NormalCohesiveZone(work_of_separation=0.1, normal_length=1.0)
    path = cs.approaches([-1.0, 1.0], 0.5)
    with refused("accuracy", "paths over measured heights"):
        cs.simulate(cs.Scene(cs.HalfSpace(1.0), cs.Topography(heights(128 + 16), 2.0), law, path), accuracy=0.1)
    with refused("surface", "heights that differ"):
        cs.estimate_cost(scene_of(np.zeros(64)), accuracy=0.1)


def test_words_of_a_forecast_say_that_the_error_is_known_afterwards():
    setup = Setup(scene_of(heights(256)), RunOptions(accuracy=Accuracy(0.1)))
    text = describe_forecasts([setup], [forecast_run(setup)])
    assert "known after the run" in text
    assert "nan" not in text
