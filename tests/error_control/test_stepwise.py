"""An accuracy without measured relations: from one grid to a finer one, until their change is small enough."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
import pytest
import yaml

import contactsim as cs
from contactsim import cli, dataset
from contactsim.error_control import grids, stepwise
from contactsim.error_control.control import Controlled, solve_to_error
from contactsim.error_control.options import choose_options
from contactsim.error_control.solution import relative_difference, solve_setup
from contactsim.error_control.stepwise import (
    FIRST_ERROR,
    FIRST_STEPS,
    ORDER,
    begin_stepwise,
    estimate_from_changes,
    has_relations,
    known_quantities,
    usual_quantities,
)
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from support.cases import refused

SPHERE = cs.Sphere(500.0, 2000.0)
ZONE = cs.NormalCohesiveZone(0.05, 1.0)
CYCLE = cs.approaches([-5.0, 2.0, -9.0], 1.0, from_touch=True)
ROUGH = cs.SelfAffine(512.0, 0.8, 256.0, 64.0, rms_height=5.0, dimensions=2, seed=3)
WAVE = cs.Sinusoid(100.0, 0.5)
SOFT = cs.HalfSpace(1.0)
SCENES = {
    "sphere": cs.Scene(SOFT, SPHERE, ZONE, CYCLE),
    "layer": cs.Scene(cs.Layer(0.75, 0.45, 200.0), SPHERE, ZONE, CYCLE),
    "load": cs.Scene(SOFT, SPHERE, ZONE, cs.pressures([1e-4, 4e-4], 1e-4)),
    "rough": cs.Scene(SOFT, ROUGH, ZONE, cs.approaches([-4.0, 4.0], 1.0, from_touch=True)),
    "wave": cs.Scene(SOFT, WAVE, cs.HardWall(), cs.pressures([2e-3, 8e-3])),
    "adhesive wave": cs.Scene(SOFT, WAVE, cs.NormalCohesiveZone(1e-3, 1.0), cs.pressures([2e-3, 8e-3])),
}


def reference_error(result: Controlled, refinement: int = 2) -> float:
    """Return the largest relative error against a finer grid, shorter increments and a tighter tolerance."""
    last = result.last.setup
    setup = last.with_options(points=refinement * last.points, tolerance=1e-2 * last.options.tolerance)
    if last.scene.path.increment is not None:
        setup = setup.with_increment(last.scene.path.increment / refinement)
    reference = solve_setup(setup, tuple(result.errors))
    return max(float(relative_difference(reference, result.last, name).max()) for name in result.errors)


@pytest.mark.parametrize(("name", "error"), [*((name, 0.03) for name in SCENES), ("sphere", 0.01), ("wave", 0.001)])
def test_a_scene_without_relations_is_as_accurate_as_was_asked_for(name, error):
    assert not has_relations(SCENES[name])
    result = solve_to_error(Setup(SCENES[name]), error)
    assert result.met
    assert set() < set(result.errors) <= set(usual_quantities(SCENES[name]))
    assert reference_error(result) <= error


def test_a_smaller_error_takes_a_finer_grid():
    loose, tight = (solve_to_error(Setup(SCENES["sphere"]), error) for error in (0.05, 0.002))
    assert tight.last.points > loose.last.points
    assert tight.last.setup.scene.path.increment < loose.last.setup.scene.path.increment
    assert tight.last.setup.options.tolerance < loose.last.setup.options.tolerance


@dataclass(frozen=True)
class Known:
    """A solution whose error is known."""

    points: int
    values: dict[str, np.ndarray]
    solved: bool = True


def known(points: int, value: float, solved: bool = True) -> Known:
    return Known(points, {"one": np.array([value])}, solved)


@pytest.mark.parametrize("grids", [(16, 32, 64), (16, 32, 45), (8, 16, 32, 44)])
def test_errors_that_fall_with_the_assumed_order_are_estimated_exactly(grids):
    runs = [known(points, 1.0 + 1e-3 * points**-ORDER) for points in grids]
    assert estimate_from_changes(runs, ["one"])["one"] == pytest.approx(1e-3 * grids[-1] ** -ORDER, rel=1e-3)


def test_a_last_change_that_is_small_by_chance_does_not_hide_the_one_before():
    runs = [known(16, 1.1), known(32, 1.0), known(64, 1.0)]
    expected = 0.1 / (2**ORDER - 1) / 2**ORDER
    assert estimate_from_changes(runs, ["one"])["one"] == pytest.approx(expected)


@pytest.mark.parametrize("lost", [0, 1, 2])
def test_a_run_that_was_not_solved_leaves_the_error_unknown(lost):
    runs = [known(16 * 2**place, 1.0, solved=place != lost) for place in range(3)]
    assert np.isinf(estimate_from_changes(runs, ["one"])["one"])


def test_two_grids_are_enough_where_they_hardly_differ_and_a_missed_error_is_told(monkeypatch, caplog):
    assert len(solve_to_error(Setup(SCENES["load"]), 0.3).before) == 1
    monkeypatch.setattr(stepwise, "MAX_GRIDS", 3)
    result = solve_to_error(Setup(SCENES["sphere"]), 1e-5)
    assert not result.met
    assert len(result.before) == 2
    with caplog.at_level(logging.WARNING):
        data = cs.simulate(SCENES["sphere"], accuracy=1e-5)
    assert "is not reached" in caplog.text
    assert data.accuracy_reached == 0


def test_the_first_grid_has_a_few_points_for_the_shortest_length():
    setup = choose_options(Setup(SCENES["rough"]), FIRST_ERROR)
    assert 4 <= setup.points * ROUGH.effective_short_cutoff / ROUGH.length <= 5
    assert choose_options(Setup(SCENES["rough"]), 0.1).points < setup.points
    sharp = cs.Scene(SOFT, SPHERE, cs.NormalCohesiveZone(0.5, 0.5), CYCLE)
    assert choose_options(Setup(sharp), 0.01).points > 2 * choose_options(Setup(SCENES["sphere"]), 0.01).points


def test_every_increment_of_a_path_is_solved():
    pressed, loaded = (begin_stepwise(Setup(SCENES[name]), 0.01, ()) for name in ("sphere", "load"))
    assert pressed.options.increments == Requested()
    assert pressed.scene.path.increment == 1.0
    assert loaded.options.increments == Requested()
    assert len(loaded.scene.path.steps) == FIRST_STEPS
    assert begin_stepwise(Setup(SCENES["wave"]), 0.01, ()).options.increments is None


def test_any_number_of_a_path_may_be_asked_for_and_others_are_refused():
    result = solve_to_error(Setup(SCENES["sphere"]), 0.1, ["pull_off_force_unloading", "final_force"])
    assert set(result.errors) == {"pull_off_force_unloading", "final_force"}
    with refused("accuracy.quantities", "final_contact_area"):
        choose_options(Setup(SCENES["sphere"]), 0.1, ["final_contact_length"])
    slide = cs.Scene(SOFT, ROUGH, ZONE, CYCLE)
    assert "static_friction" not in known_quantities(slide)


def test_a_wall_pressed_by_approach_is_refused():
    with refused("path", "needs loads above zero"):
        cs.simulate(cs.Scene(SOFT, SPHERE, cs.HardWall(), CYCLE), accuracy=0.1)


def test_the_shell_runs_an_adhesive_sphere_to_its_accuracy_and_knows_no_cost_beforehand(tmp_path, capsys):
    scene = {
        "surface": {"kind": "sphere", "radius": 2000.0, "length": 500.0},
        "body": {"kind": "half_space", "contact_modulus": 1.0},
        "effects": ["normal_cohesive_zone"],
        "normal_cohesive_zone": {"work_of_separation": 0.05},
        "path": {"approach": [-6.0, 2.0, -10.0], "origin": "first_touch"},
        "accuracy": 0.05,
    }
    file = tmp_path / "scene.yaml"
    file.write_text(yaml.safe_dump(scene))
    cli.main(["run", str(file)])
    assert "pull_off_force_loading to" in capsys.readouterr().out
    data = dataset.load_dataset(tmp_path / "scene.nc")
    assert data.accuracy_reached == 1
    assert data.pull_off_force_loading_estimated_error > 0
    with pytest.raises(SystemExit, match="have no relations"):
        cli.main(["estimate", str(file)])


@pytest.mark.parametrize("periods", [20, 64, 128])
def test_waves_of_any_number_are_seen_by_the_first_grid(periods):
    scene = cs.Scene(SOFT, cs.Sinusoid(100.0, 0.5 / periods, periods), cs.HardWall(), cs.pressures([2e-3, 8e-3]))
    result = solve_to_error(Setup(scene), 0.03)
    assert result.met
    assert result.before[0].points >= 2.5 * periods
    assert reference_error(result) <= 0.03


def test_a_quantity_that_a_path_does_not_have_is_no_accuracy():
    with refused("accuracy.quantities", "does not come so far"):
        solve_to_error(Setup(SCENES["rough"]), 0.1, ["pull_off_force_unloading"])
    result = solve_to_error(Setup(SCENES["rough"]), 0.1)
    assert all(np.isfinite(values).all() for values in result.errors.values())


def test_a_load_that_has_no_equilibrium_is_not_sought_on_ever_finer_grids():
    result = solve_to_error(Setup(cs.Scene(SOFT, SPHERE, ZONE, cs.pressures([1e-4, -5e-2]))), 0.1)
    assert not result.met
    assert len(result.before) == 1


def test_a_path_of_two_controls_is_refused():
    path = cs.approaches([-5.0, 2.0], 0.5) >> cs.pressures([1e-3, -2e-3], 1e-4)
    with refused("path", "one of them"):
        cs.simulate(cs.Scene(SOFT, SPHERE, ZONE, path), accuracy=0.1)
    with refused("quantities", "a list of names"):
        cs.simulate(SCENES["sphere"], accuracy=0.1, quantities="final_force")


@pytest.mark.parametrize("surface", [cs.Cylinder(500.0, 2000.0), SPHERE, ROUGH])
def test_a_load_of_zero_among_others_has_no_error(surface):
    result = solve_to_error(Setup(cs.Scene(SOFT, surface, cs.HardWall(), cs.pressures([0.0, 1e-3]))), 0.1)
    assert result.met
    assert result.last.values["relative_contact_area_subgrid"][0] == 0


def test_what_was_solved_is_kept_where_the_next_grid_would_be_too_large(monkeypatch):
    monkeypatch.setattr(grids, "MAX_POINTS", 100**2)
    result = solve_to_error(Setup(SCENES["sphere"]), 1e-4)
    assert not result.met
    assert result.last.points <= 100


def test_an_oblong_surface_has_points_on_its_shorter_side():
    scene = cs.Scene(SOFT, cs.Flat(100.0, 1.0, 10.0), cs.HardWall(), cs.pressures([1e-3]))
    assert min(scene.upper.surface.shape(choose_options(Setup(scene), 0.1).points)) >= 8
