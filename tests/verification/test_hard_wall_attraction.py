"""A hard wall that attracts: limits, known pull-offs, two methods, and states recomputed from what is stored."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from contactsim.reference import adhesion, adhesive_sphere
from contactsim.solvers.registry import make_solver
from support.cases import refused

WALL = cs.HardWall()
ROUGH = cs.SelfAffine(length=1024.0, hurst_exponent=0.8, long_cutoff=512.0, short_cutoff=32.0, rms_height=5.0, seed=3)
LOOP = cs.approaches([-6.0, 6.0, -8.0], 1.0, from_touch=True)


def loop(effects, points=512, *, surface=ROUGH, body=None, path=LOOP, **options):
    """Press and pull off, by default rough lines on a half-space of unit modulus; every state has converged."""
    scene = cs.Scene(cs.HalfSpace(1.0) if body is None else body, surface, effects, path)
    data = cs.simulate(scene, points=points, **{"tolerance": 1e-5, **options})
    assert data.status.isin([0, 5]).all()  # converged, or interpolated between such
    return data


def residuals(data, law, modulus):
    """Return how far stored states are from equilibrium at gaps that were never negative, by numpy alone.

    Residual over the strength; largest overlap, and largest gap where the wall pushes, in lengths of the law.
    """
    spacing = float(data.length) / data.sizes["x"]
    wavenumber = 2 * np.pi * np.fft.rfftfreq(data.sizes["x"], spacing)
    worst = overlap = opening = 0.0
    for state in (data.isel(snapshot=at) for at in range(data.sizes["snapshot"])):
        gap, traction = state.normal_gap.values, state.normal_traction.values
        moved = gap + state.heights.values
        elastic = np.fft.irfft(modulus / 2 * wavenumber * np.fft.rfft(moved), data.sizes["x"])
        balance = elastic + traction
        worst = max(worst, np.abs(balance - balance.mean()).max() / law.strength)
        pressure = law.traction(np.maximum(gap, 0.0)[None])[0] - traction
        assert (pressure >= -1e-6 * law.strength).all()
        overlap = max(overlap, -gap.min() / law.normal_length)
        opening = max(opening, gap.max(where=pressure > 1e-3 * law.strength, initial=0.0) / law.normal_length)
    return worst, overlap, opening


@pytest.mark.parametrize("law", [cs.ExponentialAttraction(0.2, 2.0), cs.NormalCohesiveZone(0.1, 1.0)], ids=repr)
def test_stored_states_are_in_equilibrium_and_never_overlap(law):
    data = loop((WALL, law), snapshots=[-2.0, 2.0, 6.0], path=cs.approaches([-6.0, 6.0], 1.0, from_touch=True))
    residual, overlap, opening = residuals(data, law, 1.0)
    assert residual <= 5e-5
    assert max(overlap, opening) <= 1e-5
    assert data.contact_length.max() > 20.0


def test_without_attraction_it_is_the_contact_of_a_hard_wall():
    """A work of 1e-6 N/m pulls with 1e-6 GPa, a ten-thousandth of the pressures."""
    weak = loop((WALL, cs.ExponentialAttraction(1e-6)), path=cs.approaches([2.0, 6.0, 10.0], from_touch=True))
    pressures = weak.mean_pressure.values.tolist()
    bare = cs.simulate(cs.Scene(cs.HalfSpace(1.0), ROUGH, WALL, cs.pressures(pressures)), points=512, tolerance=1e-5)
    assert bare.approach.values == pytest.approx(weak.approach.values, abs=2e-4)
    assert bare.max_pressure.values == pytest.approx(weak.max_pressure.values, rel=2e-3)
    assert np.abs(weak.contact_length.values / 1024 - bare.relative_contact_area.values).max() < 2 / 512


def test_a_stiffer_and_stiffer_repulsion_becomes_the_wall():
    """The difference falls as one over the stiffness."""
    path = cs.approaches([-3.0, 5.0], 2.0, from_touch=True)
    wall = loop((WALL, cs.NormalCohesiveZone(0.1)), 256, path=path)
    repulsions = [cs.StiffCohesiveZone(0.1, stiffness) for stiffness in (2.5, 10.0, 40.0)]
    forces = [loop(law, 256, path=path).line_load.values for law in repulsions]
    away = [np.abs(force - wall.line_load.values).max() for force in forces]
    assert away[0] / away[1] == pytest.approx(4, rel=0.35)
    assert away[1] / away[2] == pytest.approx(4, rel=0.35)
    assert away[2] < 0.01 * np.ptp(wall.line_load.values)


@pytest.mark.parametrize("dimensions", [1, 2])
def test_two_methods_find_the_same_states(dimensions):
    surface = cs.SelfAffine(
        length=512.0, hurst_exponent=0.8, long_cutoff=256.0, short_cutoff=64.0, rms_height=5.0, seed=1,
        dimensions=dimensions,
    )  # fmt: skip
    path = cs.approaches([-4.0, 6.0, -8.0], 1.0, from_touch=True)
    effects, points = (WALL, cs.ExponentialAttraction(0.02, 1.0)), {1: 256, 2: 32}[dimensions]
    newton, descent = (
        loop(effects, points, surface=surface, path=path, solver=make_solver(kind))
        for kind in ("newton", "energy_minimisation")
    )
    assert newton.mean_pressure.values == pytest.approx(descent.mean_pressure.values, abs=1e-6)


def test_a_prescribed_load_leads_to_the_state_of_the_approach_with_that_load():
    effects = (WALL, cs.ExponentialAttraction(0.003, 1.0))  # too weak for jumps, so that a load has one state
    by_approach = loop(effects, path=cs.approaches([-6.0, 6.0], 1.0, from_touch=True)).isel(step=slice(-4, None))
    loads = by_approach.mean_pressure.values.tolist()
    by_load = loop(effects, path=cs.pressures(loads))
    assert by_load.approach.values == pytest.approx(by_approach.approach.values, abs=1e-4)
    assert by_load.mean_pressure.values == pytest.approx(loads, rel=1e-6)
    assert by_load.contact_length.values == pytest.approx(by_approach.contact_length.values, abs=0.5)


def test_on_a_thick_layer_it_is_that_of_the_half_space():
    effects, path = (WALL, cs.ExponentialAttraction(0.05, 1.0)), cs.approaches([-6.0, 8.0], 1.0, from_touch=True)
    thick = cs.Layer(contact_modulus=1.0, poisson_ratio=0.5, thickness=1e5)
    layer = loop(effects, path=path, body=thick)
    assert layer.mean_pressure.values == pytest.approx(loop(effects, path=path).mean_pressure.values, abs=1e-6)


@pytest.mark.parametrize(("strength", "points"), [(0.05, 512), (0.1, 2048)])
def test_a_cylinder_pulls_off_as_maugis_and_dugdale_say(strength, points):
    law = cs.DugdaleAttraction(1.0, 1.0 / strength)
    path = cs.approaches([2.0, -30.0], 1.0, from_touch=True)
    data = loop((WALL, law), points, surface=cs.Cylinder(radius=1000.0, length=4000.0), path=path, tolerance=1e-4)
    expected = float(adhesion.maugis_cylinder_pull_off(1.0, 1000.0, 1.0, strength))
    assert -data.line_load.values.min() == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("law", [cs.ExponentialAttraction(1.0, 20.0), cs.DugdaleAttraction(1.0, 20.0)], ids=repr)
def test_a_rigid_sphere_pulls_off_with_twice_pi_work_and_radius(law):
    """Just before it touches, as a contact would carry the sag of the body about it."""
    body, sphere = cs.FreeHalfSpace(1e6), cs.Sphere(radius=20000.0, length=4000.0)
    data = loop((WALL, law), 64, surface=sphere, body=body, path=cs.approaches([-0.01], from_touch=True))
    assert -data.normal_force.values.min() == pytest.approx(adhesive_sphere.dmt_pull_off(1.0, 20000.0), rel=0.02)


@pytest.mark.parametrize(("size", "points"), [(0.5, 48), (1.0, 64)])
def test_a_sphere_pulls_off_as_maugis_and_dugdale_say(size, points):
    strength = size / adhesive_sphere.maugis_parameter(1.0, 1000.0, 1.0, 1.0)
    law, sphere = cs.DugdaleAttraction(1.0, 1.0 / strength, ramp=0.5), cs.Sphere(radius=1000.0, length=500.0)
    path = cs.approaches([-4.0, -6.0, -8.0, -9.0, -10.0, -12.0], from_touch=True)
    data = loop((WALL, law), points, surface=sphere, body=cs.FreeHalfSpace(1.0), path=path, tolerance=1e-3)
    expected = adhesive_sphere.maugis_pull_off(1.0, 1000.0, 1.0, strength)
    assert -data.normal_force.values.min() == pytest.approx(expected, rel=0.02)


def test_energy_that_a_loop_dissipates_is_never_negative_and_none_without_jumps():
    calm = loop((WALL, cs.ExponentialAttraction(0.003, 2.0)), 256)
    assert not (calm.jump > 0).any()
    area = np.trapezoid(calm.line_load.values, calm.approach.values)
    assert abs(area) < 1e-3 * np.abs(calm.line_load.values).max() * np.ptp(calm.approach.values)
    strong = loop((WALL, cs.ExponentialAttraction(0.1, 2.0)), 128, tolerance=1e-4)
    assert (strong.jump > 0).any()
    assert np.trapezoid(strong.line_load.values, strong.approach.values) > 0


def test_a_tensile_load_holds_up_to_the_pull_off_and_no_further():
    effects = [WALL, cs.ExponentialAttraction(0.02, 2.0)]
    held = loop(effects, 256, path=cs.pressures([0.01, -3e-4, -5e-4]))
    assert held.mean_pressure.values == pytest.approx([0.01, -3e-4, -5e-4], rel=1e-6)
    scene = cs.Scene(cs.HalfSpace(1.0), ROUGH, effects, cs.pressures([0.01, -3e-4, -1e-2]))
    assert cs.simulate(scene, points=256, tolerance=1e-5).status.values.tolist() == [0, 0, 3]


def test_a_load_from_far_apart_takes_few_transforms():
    surface = cs.SelfAffine(256.0, 0.8, 128.0, 32.0, rms_height=3.0, seed=3, dimensions=2)
    path = cs.pressures([0.0, 0.05])
    data = loop((WALL, cs.ExponentialAttraction(0.02, 1.0)), 24, surface=surface, path=path)
    assert data.transforms.values.sum() < 4000


def test_beyond_closure_there_is_no_state_and_the_path_comes_back():
    """The mean displacement is fixed, so the approach decides the mean gap."""
    scene = cs.Scene(
        cs.HalfSpace(1.0), ROUGH, (WALL, cs.ExponentialAttraction(0.02, 2.0)), cs.approaches([0.0, 5.0, 0.0], 5.0)
    )
    data = cs.simulate(scene, points=128, tolerance=1e-4)
    mean_gap = -ROUGH.heights(128).mean() - np.array([5.0, 0.0])
    assert (data.status.values == np.where(mean_gap < 0, 3, 0)).all()
    assert set(data.status.values) == {0, 3}


def test_nested_and_adaptive_increments_give_the_states_of_requested_ones():
    effects, path = (WALL, cs.ExponentialAttraction(0.02, 2.0)), cs.approaches([-6.0, 6.0], 1.0, from_touch=True)
    every = loop(effects, path=path, points=1024)
    nested = loop(effects, path=path, points=1024, increments=cs.Nested([0.0, 6.0], coarse_ratio=4))
    adaptive = loop(effects, path=path, points=1024, increments=cs.Adaptive())
    full = nested.solved_points.values == 1024
    assert full.sum() == 2
    assert nested.mean_pressure.values[full] == pytest.approx(every.mean_pressure.values[full], abs=1e-6)
    assert adaptive.mean_pressure.values == pytest.approx(every.mean_pressure.values, abs=2e-5)


def test_scenes_of_walls_and_laws_that_are_not_solved_are_refused():
    body, attraction = cs.HalfSpace(1.0, poisson_ratio=0.3), cs.ExponentialAttraction(0.1)
    with refused("effects", "resists overlap"):
        cs.Scene(body, ROUGH, attraction, LOOP)
    with refused("effects", "normal gap alone"):
        cs.Scene(body, ROUGH, (WALL, cs.CohesiveZone(0.1, 0.5)), LOOP)
    with refused("effects", "one hard wall"):
        cs.Scene(body, ROUGH, (WALL, WALL, attraction), LOOP)
    for effects in ([WALL, "adhesion"], (WALL, cs.ExponentialAttraction), (cs.HardWall, attraction), 3.0):
        with refused("effects", "Effect: HardWall()"):
            cs.Scene(body, ROUGH, effects, LOOP)
    with refused("hardness", "left out"):
        cs.Scene(body, ROUGH, (cs.HardWall(hardness=2.0), attraction), LOOP)
    for solver in ("active_set", "damped_verlet", "polonsky_keer"):
        with refused("solver", "one that accepts"):
            cs.simulate(cs.Scene(body, ROUGH, (WALL, attraction), LOOP), points=64, solver=solver)
    with refused("solver", "accepts WALL"):
        cs.simulate(cs.Scene(body, ROUGH, WALL, cs.pressures([0.01])), points=64, solver="newton")
