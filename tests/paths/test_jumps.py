"""Jumps told from smooth motion: by distance, and by the energy that a step releases."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.contact.loading import approaches, pressures, sliding
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.interface.lattice import Lattice
from contactsim.observables.path_summary import summarise_load_curves
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.continuation import Continuation
from contactsim.simulation import simulate
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid, Sphere
from contactsim.surfaces.topography import Topography
from support.smooth import along, walk

SHAPES = {"line": (Cylinder(radius=2000.0, length=1000.0), 512), "surface": (Sphere(radius=2000.0, length=1000.0), 64)}


def loop(surface, increment):
    """Press an adhesive cylinder or sphere into a half-space, and pull it off."""
    path = along(-8, 4, increment) >> along(4 - increment, -12, increment)
    return Scene(HalfSpace(1.0), surface, NormalCohesiveZone(work_of_separation=0.15), path)


@pytest.fixture
def accepted(monkeypatch):
    """Load parameters of all states that a path accepts."""
    values = []
    accept = Continuation.accept

    def record(path, step, state, flowed):
        values.append(step.value)
        return accept(path, step, state, flowed)

    monkeypatch.setattr(Continuation, "accept", record)
    return values


@pytest.mark.parametrize("name", SHAPES)
def test_steps_without_a_jump_are_taken_whole_and_both_jumps_are_located(accepted, name):
    surface, points = SHAPES[name]
    path = walk(loop(surface, 1.0), points, tolerance=1e-4)
    folds = [jump for state in path.states for jump in state.jumps]
    assert len(folds) == 2
    assert all(abs(fold.step.value - fold.step_before.value) <= 0.002 for fold in folds)
    in_contact = [value for value in accepted if -4 < value <= 4]
    assert len(in_contact) <= 20  # 16 steps
    fine = walk(loop(surface, 1 / 16), points, tolerance=1e-6)
    finer = [jump for state in fine.states for jump in state.jumps]
    assert [fold.step.value for fold in folds] == pytest.approx([fold.step.value for fold in finer], abs=0.005)
    assert [fold.distance for fold in folds] == pytest.approx([fold.distance for fold in finer], rel=0.01)


def test_the_last_valley_of_a_nearly_full_contact_closes_in_a_whole_step(accepted):
    surface = SelfAffine(10240.0, 0.2, 1280.0, 80.0, rms_height=10.0, seed=1)
    scene = Scene(HalfSpace(87.8), surface, NormalCohesiveZone(3.5), along(1.5, 4.5, 1.0))
    steps = walk(scene, 1024, tolerance=1e-4)
    assert accepted == [1.5, 2.5, 3.5, 4.5]  # none is divided
    assert not steps.jumps
    finer = walk(replace(scene, path=along(1.5, 4.5, 1 / 32)), 1024, tolerance=1e-6)
    assert not finer.jumps  # it is smooth
    assert steps.load == pytest.approx(finer.load[::32], rel=1e-3)


def test_the_jump_of_a_single_groove_is_located_though_it_moves_few_points():
    place = np.arange(1024) * 4000.0 / 1024 - 2000.0
    groove = Topography(-10.0 * np.exp(-((place / 60.0) ** 2)), spacing=4000.0 / 1024)
    jumps = {}
    for increment in (1.0, 1 / 8):
        path = along(-1.0, 2.0, increment) >> along(2.0 - increment, -1.0, increment)
        states = walk(Scene(HalfSpace(1.0), groove, NormalCohesiveZone(0.3), path), 1024, tolerance=1e-5).states
        jumps[increment] = [jump for state in states for jump in state.jumps if jump.distance > 1.0]
    assert [jump.step.value for jump in jumps[1.0]] == pytest.approx([0.174, 0.109], abs=0.002)  # in and out
    assert [jump.step.value for jump in jumps[1.0]] == pytest.approx([jump.step.value for jump in jumps[1 / 8]])
    assert all(abs(jump.step.value - jump.step_before.value) < 0.002 for jump in jumps[1.0])


def test_long_steps_among_many_contacts_are_halved_and_not_divided_further(accepted):
    surface = SelfAffine(10240.0, 0.2, 1280.0, 80.0, rms_height=10.0, seed=1)
    scene = Scene(HalfSpace(87.8), surface, NormalCohesiveZone(10.5), along(-5.0, 1.0, 1.5))
    long = walk(scene, 1024, tolerance=1e-4)
    assert min(np.diff(accepted)) == 0.75  # the law's length is 1
    short = walk(replace(scene, path=along(-5.0, 1.0, 0.75)), 1024, tolerance=1e-4)
    assert long.load == pytest.approx(short.load[::2], rel=1e-3)
    assert long.transforms < 3 * short.transforms


@pytest.mark.parametrize("seed", [2, 7])
@pytest.mark.parametrize("increment", [0.5, 0.25])
def test_the_pull_off_of_a_rough_line_is_that_of_small_steps_within_its_error(seed, increment):
    surface = SelfAffine(5120.0, 0.5, 640.0, 40.0, rms_height=4.5, seed=seed)
    touch = -float(surface.heights(1024).max())
    found = []
    for step in (increment, increment / 16):
        path = approaches([touch - 6.0, touch + 5.5, touch - 20.0], step)
        scene = Scene(HalfSpace(87.8), surface, NormalCohesiveZone(7.7), path)
        found.append(summarise_load_curves(simulate(scene, points=1024, tolerance=1e-4)))
    for leg in ("loading", "unloading"):
        coarse, fine = (float(data[f"pull_off_load_{leg}"]) for data in found)
        error = float(found[0][f"pull_off_load_{leg}_increment_error"])
        assert abs(coarse - fine) <= error < 0.06 * fine


def test_a_step_releases_energy_where_it_passes_a_jump_alone():
    surface, points = SHAPES["line"]
    path = walk(loop(surface, 0.5), points, tolerance=1e-6)
    released = {}
    for before, after in zip(path.states, path.states[1:], strict=False):
        energies = [
            path.problem.at(state.step).energy(state.displacement, state.solution.gap) for state in (before, after)
        ]
        forces = [-state.solution.traction[0].mean() for state in (before, after)]
        step = after.step.value - before.step.value
        released[bool(after.jump), after.step.value] = sum(forces) / 2 * step - (energies[1] - energies[0])
    jumps = [value for (is_jump, _), value in released.items() if is_jump]
    smooth = [abs(value) for (is_jump, _), value in released.items() if not is_jump]
    assert len(jumps) == 2
    assert min(jumps) > 5 * max(smooth)


@pytest.mark.parametrize("name", SHAPES)
def test_a_loose_tolerance_takes_no_more_work_and_finds_the_same_jumps(name):
    surface, points = SHAPES[name]
    exact, loose = (walk(loop(surface, 0.5), points, tolerance=tolerance) for tolerance in (1e-5, 0.1))
    assert loose.transforms < exact.transforms
    assert loose.jumps == exact.jumps


PATTERNED = Scene(
    Body(Flat(length=40.0)),
    Body(Flat(length=40.0), HalfSpace(1.0, 0.499)),
    CohesiveZone(work_of_separation=3.3, tangential_length=1.3),
    along(-4.03, -3.53, 0.25),
)
"""Flat bodies that jump towards each other in patterns. A pattern can stand anywhere along them."""


def jumps_of(scene, points, **options):
    """Both loads of each jump of a path."""
    states = walk(scene, points, **options).states
    return [(jump.step_before.value, jump.step.value) for state in states for jump in state.jumps]


def test_states_that_drift_by_less_than_a_jump_are_not_sought_in_ever_smaller_steps(accepted):
    increments = Adaptive(error=0.005, least=0.014, most=7.0, fold_width=3e-5)
    exact = jumps_of(PATTERNED, 64, tolerance=1e-7, increments=increments)
    assert [after for _, after in exact] == pytest.approx([-4.010, -3.845, -3.681], abs=0.002)
    accepted.clear()
    found = jumps_of(PATTERNED, 64, tolerance=5e-4, increments=increments)  # a loose tolerance lets patterns drift
    assert [after for _, after in found][:2] == pytest.approx([after for _, after in exact][:2], abs=0.02)
    assert len(accepted) < 200


def test_the_first_step_of_a_load_may_hide_a_jump_however_far_the_surface_moves():
    surface = Sinusoid(length=1000.0, amplitude=12.0)
    scene = Scene(HalfSpace(1.0), surface, NormalCohesiveZone(work_of_separation=0.15), pressures([5e-4, 8e-3, 1.2e-2]))
    ((before, after),) = jumps_of(scene, 256)
    assert 0.005 < before < after < 0.0052


@pytest.mark.parametrize("increment", [2.44, 4.88])
def test_a_slip_by_whole_cells_is_found_though_the_surface_is_as_before(increment):
    cylinder, cell = Cylinder(radius=2000.0, length=1000.0), 2.44
    path = approaches([0.0, 2.0]) >> sliding([0.0, 4 * cell], increment, approach=2.0)
    bodies = Body(Flat.facing(cylinder)), Body(cylinder, HalfSpace(1.0, 0.3))
    assert len(jumps_of(Scene(*bodies, CohesiveZone(0.15, 0.15), path, Lattice(cell)), 512)) == 4


def test_a_jump_is_found_in_a_step_that_ends_where_the_surface_was():
    flat = Flat(length=40.0)
    law, path = NormalCohesiveZone(work_of_separation=3.3), approaches([1.0, 0.5, 0.0, -30.0])
    ((before, after),) = jumps_of(Scene(Body(flat), Body(flat, Layer(1.0, 0.3, 20.0)), law, path), 64)
    assert -20.9 < after < before < -20.8
