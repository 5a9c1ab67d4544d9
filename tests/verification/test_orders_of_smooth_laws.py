"""Observed orders of convergence of paths under smooth laws: grid, increment, tolerance, stiffness, Poisson's ratio."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from contactsim import reference
from contactsim.contact.loading import LoadPath, approaches, sweep
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import Slide
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.lattice import Lattice
from contactsim.observables.adhesion import contact_length, pull_off
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid
from contactsim.traits import Trait
from support.cases import orders
from support.smooth import LAWS, Walked, along, scene_of, walk

CYLINDER, WAVE = Cylinder(length=1000.0, radius=2500.0), Sinusoid(length=1000.0, amplitude=2.0)
BODIES = {
    "half-space": HalfSpace(77.0, 0.3),
    "layer": Layer(77.0, 0.3, 200.0),
    "incompressible": Layer(77.0, 0.5, 200.0),
}
WEAK = {
    "uncoupled": NormalCohesiveZone(0.2),
    "frictional": CohesiveZone(0.2, 1.0),
    "uncoupled_frictional": UncoupledCohesiveZone(0.2, 1.0),
}
"""Laws too weak for a jump."""
PARTS = (0.0, 0.2, 0.4, 0.6, 0.8)
"""Where paths begin, in increments: the worst of them counts, for by chance one may meet the largest pull."""


def pull_off_of(result: Walked) -> float:
    """Return the pull-off on loading, N/m."""
    approach = np.array([state.step.value for state in result.states])
    return pull_off(approach, result.load)["pull_off_load_loading"]


# --- the grid -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", LAWS)
def test_the_load_of_a_cylinder_converges_faster_than_the_sixth_order(name):
    scene = scene_of(LAWS[name], approaches([0.0, 2.0]))
    loads = [walk(scene, points, tolerance=1e-9).load[-1] for points in (128, 256, 512, 2048)]
    errors = np.abs(np.subtract(loads[:-1], loads[-1]))
    assert all(np.log2(coarse / fine) > 6 for coarse, fine in pairwise(errors))
    assert errors[-1] < 1e-8 * abs(loads[-1])


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("law", WEAK)
@pytest.mark.parametrize("surface", [CYLINDER, WAVE], ids=["cylinder", "wave"])
def test_a_pull_off_without_a_jump_converges_with_the_grid_faster_than_the_tenth_order(surface, law, body):
    scene = scene_of(WEAK[law], along(-3.0, 1.0, 0.25), BODIES[body], surface=surface)
    coarse, fine, exact = (pull_off_of(walk(scene, points, tolerance=1e-10)) for points in (16, 32, 128))
    assert abs(fine - exact) < max(2.0**-10 * abs(coarse - exact), 1e-10 * exact)
    assert fine == pytest.approx(exact, rel=1e-7)


@pytest.mark.parametrize("law", WEAK)
def test_the_contact_length_of_a_cylinder_converges_with_the_grid_at_second_order(law):
    steps = [0.0, 0.5, 1.0, 1.5, 2.0]
    scene = scene_of(WEAK[law], approaches(steps), BODIES["half-space"], surface=CYLINDER)

    def lengths(points: int) -> np.ndarray:
        result = walk(scene, points, tolerance=1e-8)
        return np.array([contact_length(result.gap(step)[0], CYLINDER.length / points) for step in range(len(steps))])

    exact = lengths(4096)
    errors = [np.sqrt(np.mean((lengths(points) - exact) ** 2)) for points in (128, 256, 512)]
    assert orders(errors) == pytest.approx([2, 2], abs=0.2)


# --- increments ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [*WEAK.values(), CohesiveZone(2.0)], ids=repr)
def test_a_pull_off_without_a_jump_converges_with_the_increment_at_second_order(law):
    def worst_pull_off(increment: float, parts: tuple[float, ...]) -> float:
        paths = [along(-3.0 + part * increment, 0.2 + part * increment, increment) for part in parts]
        results = [walk(scene_of(law, path, BODIES["layer"], surface=CYLINDER), 64, tolerance=1e-8) for path in paths]
        assert not any(result.jumps for result in results)
        return min(pull_off_of(result) for result in results)

    exact = worst_pull_off(0.01, (0.0,))
    errors = [exact - worst_pull_off(increment, PARTS) for increment in (0.4, 0.2, 0.1)]
    assert errors[-1] > 0
    assert np.mean(orders(errors)) == pytest.approx(2, abs=0.25)


@pytest.mark.parametrize("law", ["uncoupled", "frictional"])
def test_a_pull_off_at_a_jump_converges_with_the_increment_at_first_order(law):
    def worst_pull_off(increment: float, parts: tuple[float, ...]) -> float:
        paths = [along(-6.4 + part * increment, -5.2 + part * increment, increment) for part in parts]
        results = [walk(scene_of(LAWS[law], path), 128) for path in paths]
        assert all(len(result.jumps) == 1 for result in results)
        return min(pull_off_of(result) for result in results)

    exact = worst_pull_off(0.005, (0.0,))
    errors = [exact - worst_pull_off(increment, PARTS) for increment in (0.4, 0.2, 0.1)]
    assert errors[-1] > 0
    assert np.mean(orders(errors)) == pytest.approx(1, abs=0.2)


def test_the_static_friction_of_a_smooth_slide_converges_with_the_increment_at_second_order():
    ratio, modulus, work, lattice = 0.45, 2000.0, 0.2, 2.5
    surface, body = Flat(length=100.0), Layer(modulus / (1 - ratio**2), ratio, 500.0)

    def friction(increment: float, part: float) -> float:
        press = sweep(Trait.APPROACH, [-2.0, 0.0], 1.0, True)
        begin = 0.2 + part * increment
        slide = LoadPath((Slide((begin, begin + 1.6), increment, press.steps[-1]),), True)
        pairing = Lattice(lattice)
        scene = Scene(Body(Flat(100.0)), Body(surface, body), (CohesiveZone(2.0, work / 2),), press >> slide, pairing)
        return max(state.fields()[1][1].mean() for state in walk(scene, 8, tolerance=1e-9).states)

    slides = np.linspace(0.0, 2.0, 20001)
    exact = reference.uniform_slide(slides, modulus / (2 * (1 + ratio)) / 500.0, work, lattice).max()
    errors = [exact - min(friction(increment, part) for part in PARTS) for increment in (0.4, 0.2, 0.1)]
    assert errors[-1] > 0
    assert np.mean(orders(errors)) == pytest.approx(2, abs=0.3)


# --- tolerance ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("law", "solver"),
    [
        *[("uncoupled", name) for name in ("newton", "damped_verlet", "mass_weighted_verlet", "energy_minimisation")],
        *[("frictional", name) for name in ("newton", "damped_verlet", "mass_weighted_verlet")],
    ],
)
def test_the_gap_comes_closer_with_the_tolerance_at_first_order(law, solver):
    scene = scene_of(LAWS[law], approaches([0.0]))
    exact = walk(scene, 64, tolerance=1e-11).gap()
    tolerances = np.array([1e-2, 1e-4, 1e-6])
    errors = [np.abs(walk(scene, 64, solver, tolerance=tolerance).gap() - exact).max() for tolerance in tolerances]
    assert (errors < 40 * tolerances).all()  # characteristic lengths: the body is soft beside the law


# --- limits of the bodies -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "law", [CohesiveZone(1.0, 0.5), UncoupledCohesiveZone(1.0, 0.5), NormalCohesiveZone(1.0)], ids=repr
)
def test_a_stiff_cylinder_pulls_off_like_a_rigid_one_at_first_order_in_its_compliance(law):
    exact = reference.rigid_cylinder_pull_off(1.0, 500.0, 1.0)
    errors = []
    for modulus in (2e4, 4e4, 8e4):
        scene = scene_of(law, approaches([-0.5]), HalfSpace(modulus, 0.3), surface=Cylinder(400.0, 500.0))
        errors.append(abs(exact + walk(scene, 128, tolerance=1e-10).load[0]))
    assert errors[-1] < 1e-4 * exact
    assert orders(errors) == pytest.approx([1, 1], abs=0.01)


@pytest.mark.parametrize("name", LAWS)
def test_a_stiff_upper_body_is_rigid_at_first_order_in_its_compliance(name):
    uppers = [None, *(Layer(modulus, 0.3, 5000.0) for modulus in (1e6, 2e6, 4e6))]
    bodies = [(HalfSpace(77.0, 0.3), upper) for upper in uppers]
    rigid, *loads = (walk(scene_of(LAWS[name], None, *pair), 128, tolerance=1e-9).load[0] for pair in bodies)
    assert orders(np.abs(np.subtract(loads, rigid))) == pytest.approx([1, 1], abs=0.01)


@pytest.mark.parametrize("name", LAWS)
def test_a_layer_becomes_incompressible_at_first_order_in_its_poisson_ratio(name):
    scenes = [scene_of(LAWS[name], None, Layer(77.0, 0.5 - part, 5000.0)) for part in (0.0, 0.02, 0.01, 0.005)]
    exact, *loads = (walk(scene, 128, tolerance=1e-9).load[0] for scene in scenes)
    assert orders(np.abs(np.subtract(loads, exact))) == pytest.approx([1, 1], abs=0.1)
