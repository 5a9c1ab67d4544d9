"""Observed orders of convergence of paths under smooth laws: grid, increment, tolerance, stiffness, Poisson's ratio."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

from contactsim.contact.loading import LoadPath, approaches, sweep
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import Slide
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.interface.base import Law
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.lattice import Lattice
from contactsim.observables.adhesion import contact_length
from contactsim.observables.load_curve import LoadCurve
from contactsim.observables.path_summary import pull_off, summarise_load_curves
from contactsim.paths.requested import Requested
from contactsim.reference import adhesion, springs
from contactsim.simulation import simulate
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
    """Return the pull-off on loading without a jump, N/m."""
    approach = np.array([state.step.value for state in result.states])
    curve = LoadCurve.from_states(approach, result.load, np.zeros(approach.size))
    return pull_off(curve)["pull_off_load_loading"]


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


def jump_in(law: Law, begin: float, increment: float, fold_width: float) -> xr.Dataset:
    """Return the summary of a path of 1.2 nm that jumps to contact."""
    scene = scene_of(law, along(begin, begin + 1.2, increment))
    data = simulate(scene, points=128, tolerance=1e-7, increments=Requested(fold_width))
    assert np.count_nonzero(data.jump) == data.sizes["fold"] == 1
    return summarise_load_curves(data)


@pytest.mark.parametrize("law", ["uncoupled", "frictional"])
def test_a_pull_off_at_a_jump_converges_with_the_width_of_the_jump_at_first_order_within_its_error(law):
    exact = float(jump_in(LAWS[law], -6.4, 0.1, 2e-5).pull_off_load_loading)
    worst = []
    for width in (0.02, 0.005, 0.00125):
        paths = [jump_in(LAWS[law], -6.4 + part * 0.02, 0.1, width) for part in PARTS]
        errors = [exact - float(path.pull_off_load_loading) for path in paths]
        stated = [float(path.pull_off_load_loading_increment_error) for path in paths]
        # beyond the rounding of the exact one, and the curvature of the branch after the jump
        assert all(-1e-3 < error <= 1.2 * bound + 1e-3 for error, bound in zip(errors, stated, strict=True))
        assert all(path.pull_off_approach_loading_increment_error <= width for path in paths)
        worst.append(max(errors))
    assert np.mean(orders(worst)) == pytest.approx(2, abs=0.4)  # a fourth of the width in each step
    assert worst[-1] > 0


@pytest.mark.parametrize("increment", [0.4, 0.1, 0.02])
def test_a_pull_off_at_a_jump_does_not_depend_on_the_increment(increment):
    finest, coarse = (jump_in(LAWS["frictional"], -6.4, *knobs) for knobs in ((0.005, 1e-4), (increment, 0.002)))
    change = abs(float(coarse.pull_off_load_loading - finest.pull_off_load_loading))
    assert change <= float(coarse.pull_off_load_loading_increment_error) < 3e-4 * float(finest.pull_off_load_loading)


@pytest.mark.parametrize("width", [0.05, 0.002, 0.0005])
@pytest.mark.parametrize("increment", [0.3, 0.1, 0.02])
def test_a_flat_layer_jumps_at_the_fold_of_a_spring(increment, width):
    """The layer is a spring of stiffness E/h: it jumps where the law's traction falls as fast as the spring's."""
    work, modulus, thickness = 2.0, 25.0, 500.0
    stiffness, law = modulus / thickness, NormalCohesiveZone(work)

    def pull(gap: float) -> float:
        return float(law.traction(np.array([[gap]]))[0, 0])

    def balance(gap: float) -> float:
        return stiffness * (-fold - gap) - pull(gap)

    gap = brentq(lambda gap: float(law.tangent(np.array([[gap]]))[1][0, 0, 0]) + stiffness, 2.0, 10.0)
    fold = -gap - pull(gap) / stiffness
    exact = 100.0 * pull(brentq(balance, 0.0, 1.0))
    path = along(-8.0, -3.0 - (5.0 % increment), increment)
    scene = scene_of(law, path, Layer(modulus, 0.0, thickness), surface=Flat(100.0))
    found = summarise_load_curves(simulate(scene, points=8, tolerance=1e-10, increments=Requested(width)))
    assert found.sizes["fold"] == 1
    before, after = float(found.fold_approach_before[0]), float(found.fold_approach_after[0])
    assert before <= fold <= after
    assert after - before <= width
    error = float(found.pull_off_load_loading_increment_error)
    assert -1e-9 <= exact - float(found.pull_off_load_loading) <= 1.1 * error
    assert error <= 1.1 * 100.0 * stiffness * width


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
    exact = springs.uniform_slide(slides, modulus / (2 * (1 + ratio)) / 500.0, work, lattice).max()
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
    exact = adhesion.rigid_cylinder_pull_off(1.0, 500.0, 1.0)
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
