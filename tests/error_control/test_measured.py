"""Accuracy and cost of measured heights: the error is what every second and every fourth point change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import contactsim as cs
from contactsim.error_control import ladder
from contactsim.error_control.estimates import tell_error
from contactsim.error_control.forecast import describe_forecasts, forecast_run
from contactsim.error_control.ladder import solve_to_error, solve_with_errors
from contactsim.paths.options import Accuracy, RunOptions, Setup
from contactsim.status import Status
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
def test_the_error_is_told_by_every_second_and_every_fourth_point(body):
    values, name = heights(512), "relative_contact_area_subgrid"
    data = cs.simulate(scene_of(values, body), accuracy=0.05)
    areas = [cs.simulate(scene_of(values[::stride], body))[name].values for stride in (4, 2, 1)]
    assert data.points.item() == 512
    error = data[f"{name}_estimated_error"]
    assert error.values == pytest.approx(tell_error(areas, (2.0, 2.0)), rel=1e-3)
    assert data.accuracy_reached.item() == int((error <= 0.05 * data[name]).all())


def test_errors_of_a_run_as_it_is_are_those_of_an_accuracy():
    scene, name = scene_of(heights(512)), "relative_contact_area_subgrid_estimated_error"
    told, asked = cs.simulate(scene, errors=True), cs.simulate(scene, accuracy=0.01)
    assert told[name].values == pytest.approx(asked[name].values, rel=1e-3)
    assert "accuracy" not in told


def test_all_points_that_were_not_solved_have_no_finite_error(monkeypatch):
    solve_setup = ladder.solve_setup

    def fail(setup, *rest):
        found = solve_setup(setup, *rest)
        unsolved = found.data.assign(status=found.data.status * 0 + Status.MAX_ITERATIONS.value[0])
        return replace(found, data=unsolved) if found.points == 130 else found

    monkeypatch.setattr(ladder, "solve_setup", fail)  # 128 of the points can be thinned out
    result = solve_to_error(Setup(scene_of(heights(130))), 0.9)
    assert result.last.points == 130
    assert not result.met
    assert np.isinf(ladder.largest_error(result.errors))


@pytest.mark.parametrize("points", [64, 90])
def test_pressed_heights_tell_errors_that_cover_finer_points(points):
    def press(count, **options):
        surface = heights(count, 64.0, 2)
        return cs.press(surface, contact_modulus=1.0, mean_pressure=0.05, spacing=512.0 / count, **options)

    result, fine = press(points, errors=True), press(512)
    assert press(points).errors is None
    for name in ("relative_contact_area", "mean_gap", "max_pressure", "approach"):
        assert abs(result.numbers[name] - fine.numbers[name]) <= result.errors[name], name
    with refused("errors", "16 points each way"):
        cs.press(np.arange(6.0), contact_modulus=1.0, mean_pressure=0.05, spacing=1.0, errors=True)


def test_what_is_given_has_no_error_and_an_area_in_points_has_that_of_its_edges():
    """A flat punch: all grids have the same contact, which may end anywhere between two points."""
    punch = np.where(np.abs(np.arange(64) - 32) < 16, 0.0, -10.0)
    options = {"contact_modulus": 1.0, "spacing": 1.0, "errors": True}
    pushed = cs.press(punch, mean_pressure=0.01, **options)
    assert pushed.errors["relative_contact_area"] >= 0.5 * 2 / 64
    assert "mean_pressure" not in pushed.errors
    sunk = cs.press(heights(128), approach=-0.5, **options)
    assert sunk.errors["mean_pressure"] > 0
    assert "approach" not in sunk.errors


def test_a_path_over_measured_heights_has_no_finer_grid():
    law = cs.NormalCohesiveZone(work_of_separation=0.05, normal_length=1.0)
    topography = cs.Topography(heights(128, 64.0) / 5, 4.0, periodic=True)
    path = cs.approaches([-3.0, 2.0], 1.0, from_touch=True)
    scene = cs.Scene(cs.HalfSpace(1.0), topography, law, path)
    result = solve_to_error(Setup(scene), 1e-4, ["final_contact_length"])
    runs = [*result.before, result.last]
    assert [run.points for run in runs] == [32, 64, 128]
    increments = [run.setup.scene.path.increment for run in runs]
    assert increments == [4 * increments[-1], 2 * increments[-1], increments[-1]]
    assert not result.met
    told = solve_with_errors(result.last.setup, ["final_contact_length"])
    assert told.errors["final_contact_length"] == pytest.approx(result.errors["final_contact_length"])


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
        assert forecast.points == data.points.item()


def test_of_a_number_of_points_that_four_does_not_divide_the_error_is_that_of_the_part_that_it_divides():
    """Hertz on 65 points: the coarser grids have the length of 64, and the error is not that of another length."""
    x = (np.arange(65) - 32) / 16
    scene = cs.Scene(
        cs.FreeHalfSpace(1.0),
        cs.Topography(-(x[:, None] ** 2 + x**2) / 2, 1 / 16),
        cs.HardWall(),
        cs.pressures([4 / 3 / (65 / 16) ** 2]),
    )
    data = cs.simulate(scene, accuracy=0.1, quantities=["approach", "relative_contact_area_subgrid"])
    assert data.points.item() == 65
    assert data.coarse_run_points.item() == 64
    assert data.refinements.item() == 0
    assert data.approach.item() == pytest.approx(1, abs=1e-3)
    assert abs(data.approach.item() - 1) <= data.approach_estimated_error.item() < 0.02


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


def test_what_has_no_coarser_grid_is_refused():
    with refused("surface", "16 points or more each way"):
        cs.simulate(scene_of(heights(257)[:6], cs.FreeHalfSpace(1.0)), accuracy=0.1)


def test_a_forecast_of_measured_heights_has_their_points():
    setup = Setup(scene_of(heights(256)), RunOptions(accuracy=Accuracy(0.1)))
    text = describe_forecasts([setup], [forecast_run(setup)])
    assert "256 points" in text
    assert "nan" not in text
