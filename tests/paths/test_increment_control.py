"""Increments by the error of the predictions, and what lies between the states that were solved: by hand."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from contactsim.contact.loading import approaches, sliding
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.layer import Layer
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.interface.lattice import Lattice
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.continuation import Continuation
from contactsim.paths.increment_control import SAFETY, IncrementController
from contactsim.paths.jumps import JumpCriterion
from contactsim.paths.legs import Leg
from contactsim.paths.segments import Segment
from contactsim.simulation import simulate
from contactsim.solvers.cohesive.base import Equilibrium
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait
from support.smooth import along, residual_of, scene_of, walk


@pytest.mark.parametrize("order", [0, 1, 3])
@pytest.mark.parametrize("increment", [0.08, 0.12])
def test_one_increment_is_enough_to_find_the_one_whose_error_is_allowed(order, increment):
    exact = 0.1  # the error is that of a polynomial of the order: it is 0.005 there
    controller = IncrementController(error=0.005, smallest=1e-3, largest=10.0, increment=increment)
    controller.accept(0.005 * (increment / exact) ** (order + 1), order, flowed=False)
    assert controller.increment == pytest.approx(SAFETY * exact, rel=1e-12)


def test_the_last_two_increments_are_equal_and_the_path_ends_where_it_shall():
    for end in (2.7, -2.7):
        controller, places = IncrementController(0.005, 0.01, 1.0, 1.0), [0.0]
        while places[-1] != end:
            places.append(controller.propose(places[-1], end))
        increments = np.abs(np.diff(places))
        assert increments == pytest.approx([1.0, 0.85, 0.85])


def test_a_jump_between_two_requested_states_is_told_once_wherever_its_far_side_lies():
    leg = Leg([LoadStep(Trait.APPROACH, value) for value in (0.0, 1.0, 2.0)])
    jump, state = SimpleNamespace(distance=3.0), SimpleNamespace()
    for parameter, jumps in ((0.0, ()), (1.0, (jump,)), (1.5, (jump,)), (2.0, ())):
        leg.add(parameter, state, jumps)
    assert [len(leg.jumps_before(value)) for value in (0.0, 1.0, 2.0)] == [0, 1, 1]


def states_of(problem, parameters, residual):
    """States of a uniform displacement that is a cubic of the parameter from 2 to 5, and far from it elsewhere."""
    for parameter in parameters:
        value = parameter**3 / 100 if 2 <= parameter <= 5 else 7.0
        displacement = np.zeros(problem.unknowns, complex)
        displacement[0, 0] = value
        gap = np.full((1, problem.grid.size), value)
        yield parameter, Equilibrium(displacement, gap, problem.traction(gap), Status.CONVERGED, residual, 0.0, 1)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_state_between_others_follows_from_the_two_nearest_on_each_side_and_inherits_their_residuals(direction):
    scene, residual = scene_of(NormalCohesiveZone(2.0), surface=Flat(100.0)), 1e-5
    problem, segment = pose_cohesive(scene, scene.heights(8), 1e-7), Segment()
    for parameter, state in states_of(problem, [*range(8)][::direction], residual):
        segment.add(float(parameter), state)
    found = segment.interpolate(problem, 3.5)
    assert found.displacement[0, 0].real == pytest.approx(3.5**3 / 100, rel=1e-12)
    weights = np.array([-1, 9, 9, -1]) / 16
    traction = weights @ [problem.traction(np.full((1, 8), n**3 / 100))[0, 0] for n in (2, 3, 4, 5)]
    own = abs(problem.traction(found.gap)[0, 0] - traction) / problem.strength
    assert found.residual == pytest.approx(own + residual * np.abs(weights).sum(), rel=1e-9)


def test_where_increments_cannot_be_short_enough_states_are_solved_as_asked_for():
    error = 1e-4
    path = along(-4.0, 4.0, 0.25)
    found = walk(scene_of(NormalCohesiveZone(2.0), path), 64, increments=Adaptive(error=error, least=2.0, most=2.0))
    problem = found.problem
    allowed = problem.tolerance + error * problem.law_stiffness / problem.strength
    residuals = [residual_of(state.problem, state.displacement) for state in found.states]
    assert max(residuals) <= 1.02 * allowed
    assert [state.residual for state in found.states] == pytest.approx(residuals, rel=0.02, abs=3e-7)


def sliding_flats():
    """Flats over a lattice of 2.44 nm: their problem, a step of the slide, and a state at rest."""
    surface = Flat(100.0)
    path = approaches([0.0]) >> sliding([0.0, 8.0], 1.0, approach=0.0)
    bodies = Body(Flat.facing(surface)), Body(surface, Layer(77.0, 0.3, 500.0))
    scene = Scene(*bodies, (CohesiveZone(2.0, 0.1),), path, Lattice(2.44))
    problem, step = pose_cohesive(scene, scene.heights(8), 1e-7), path.steps[-1]
    gap = problem.at(step).gap(np.zeros(problem.unknowns, complex))
    state = Equilibrium(np.zeros(problem.unknowns, complex), gap, gap, Status.CONVERGED, 0.0, 0.0, 1)
    return problem, step, state


def test_a_motion_by_half_a_cell_is_a_slip_however_long_the_step():
    problem, step, _ = sliding_flats()
    jumps = JumpCriterion(problem)
    assert [jumps.is_jump(step, 1.0, share * 2.44) for share in (0.45, 0.55, 0.95)] == [False, True, True]
    assert not jumps.is_jump(step.held, 1.0, 0.95 * 2.44)  # pressing: five steps
    assert jumps.is_jump(step.held, 1.0, 5.1)


@pytest.mark.parametrize(("share", "opening", "is_same"), [(0.45, 0.0, True), (0.55, 0.0, False), (0.95, 4.0, True)])
def test_a_state_half_a_cell_on_is_on_another_branch_unless_the_surfaces_are_apart(share, opening, is_same):
    problem, step, state = sliding_flats()
    path = Continuation(problem, make_solver("newton"))
    path.current = step, state
    moved = replace(state, gap=state.gap + [[opening], [share * 2.44]])
    assert path.is_on_branch(moved) is is_same
    assert not path.is_on_branch(replace(state, largest_change=1.0))
    assert not path.is_on_branch(replace(state, unstable=True))


def test_an_instability_between_two_stable_states_is_not_stepped_over():
    # flats on a layer hardly soft enough: they are stable, and even, at gaps above and below those of a jump
    scene = scene_of(NormalCohesiveZone(2.0), along(-8.0, 1.0, 1.0), Layer(220.0, 0.3, 1000.0), surface=Flat(10000.0))
    asked, adaptive = walk(scene, 64), walk(scene, 64, increments=Adaptive(error=2.0, least=0.01, most=4.0))
    assert len(asked.jumps) == 1
    assert adaptive.jumps == asked.jumps


def test_the_loads_beside_a_jump_are_those_of_the_branches_that_it_leaves_and_reaches():
    data = simulate(scene_of(NormalCohesiveZone(2.0), along(-8.0, 0.0, 0.5)), points=128)
    step, load = int(data.fold_step[0]), data.line_load.values
    before, after = float(data.fold_load_before[0]), float(data.fold_load_after[0])
    fall = load[step - 1] - load[step]
    assert fall > 0 > load[step]  # the jump pulls the bodies together
    assert abs(before - load[step - 1]) < 0.3 * fall
    assert abs(after - load[step]) < 0.3 * fall
