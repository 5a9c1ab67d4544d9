"""Paths of smooth laws: one branch whatever the solver, the increments or the control, and an honest end."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from contactsim.contact.loading import LoadPath, approaches, pressures, sweep
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.paths.adaptive import Adaptive
from contactsim.solvers.cohesive.base import SEPARATION, cannot_carry_load
from contactsim.solvers.cohesive.newton_krylov import NewtonKrylov
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait
from support.smooth import LAWS, LAYER, LENGTH, along, residual_of, scene_of, walk

PATH = ("newton", "damped_verlet", "mass_weighted_verlet", "energy_minimisation")
JUMP = along(-6.2, -5.2, 0.1)
"""Around the jump to contact."""


def solvers_of(scene):
    return [kind for kind in PATH if scene.traits <= make_solver(kind).accepts]


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_all_solvers_follow_the_same_branch_and_jump_at_the_same_increment(name):
    scene = scene_of(LAWS[name], JUMP)
    kinds = solvers_of(scene)
    assert kinds == [kind for kind in PATH if kind != "energy_minimisation" or name == "uncoupled"]
    newton = walk(scene)
    assert len(newton.jumps) == 1
    for kind in kinds[1:]:
        other = walk(scene, method=kind)
        assert other.statuses == {"CONVERGED"}
        assert max(state.residual for state in other.states) <= 1e-7
        assert other.jumps == newton.jumps
        # a residual of 1e-7, softened by a stiffness that all but vanishes at the fold
        assert np.allclose(other.load, newton.load, rtol=1e-4, atol=0)
        assert other.transforms > 0


@pytest.mark.slow
@pytest.mark.parametrize("kind", PATH[2:])
def test_damped_dynamics_and_minimisation_follow_the_whole_loop(kind):
    law = LAWS["uncoupled"] if kind == "energy_minimisation" else LAWS["frictional"]
    scene = scene_of(law, along(-7, 1, 0.25) >> along(0.75, -18, 0.25))
    ours, other = walk(scene), walk(scene, method=kind)
    assert other.jumps == ours.jumps
    assert len(ours.jumps) == 2
    assert np.allclose(other.load, ours.load, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize(
    ("law", "pull_off"),
    [
        (CohesiveZone(2.0), 241.9),
        (CohesiveZone(2.0, 0.1), 257.7),
        (CohesiveZone(2.0, 1.0), 282.8),
        (NormalCohesiveZone(2.0), 287.6),
    ],
)
def test_pull_off_on_loading_is_that_of_chapter_4(law, pull_off):
    # found beforehand by an independent code at increments of 0.02 nm; the jump lies within one of them
    begin = walk(scene_of(law, along(-8, -5.7, 0.1) >> along(-5.68, -5.5, 0.02)), points=256)
    assert -begin.load.min() == pytest.approx(pull_off, abs=0.15)
    assert len(begin.jumps) == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_adaptive_increments_give_the_curve_of_the_requested_ones_for_less(name):
    scene = scene_of(LAWS[name], along(-10, 10, 0.02))
    asked, adaptive = walk(scene, points=2048), walk(scene, points=2048, increments=Adaptive())
    assert asked.statuses == {"CONVERGED"}
    assert adaptive.statuses == {"CONVERGED", "INTERPOLATED"}
    assert adaptive.jumps == asked.jumps
    assert len(asked.jumps) == 1
    assert np.abs(adaptive.load - asked.load).max() <= 1e-3 * -asked.load.min()
    # measured: 3.9 to 4.6; the jump costs both the same, and more of the whole on coarser grids
    assert asked.transforms >= 3.5 * adaptive.transforms


def test_a_finer_path_jumps_within_the_increment_of_the_coarse_one():
    jumps = [walk(scene_of(LAWS["frictionless"], along(-6, -5, step))).jumps for step in (0.2, 0.1, 0.02)]
    for coarse, fine, step in zip(jumps, jumps[1:], (0.2, 0.1), strict=False):
        assert len(coarse) == len(fine) == 1
        assert coarse[0] - step - 1e-9 <= fine[0] <= coarse[0] + 1e-9


def test_unloading_stays_in_contact_beyond_where_loading_jumped_in_and_ends_open():
    found = walk(scene_of(LAWS["uncoupled"], along(-10, 2, 0.2) >> along(1.8, -20, 0.2)))
    assert found.statuses == {"CONVERGED"}
    into, out = found.jumps
    assert out < into - 1
    place = np.array([state.step.value for state in found.states])
    turn = int(np.argmax(place))
    between = (out + into) / 2
    loading = np.interp(between, place[:turn], found.load[:turn])
    unloading = np.interp(-between, -place[turn:], found.load[turn:])
    assert unloading < 2 * loading < 0
    assert -found.load[turn:].min() > -found.load[: turn + 1].min()
    assert found.load[-1] == pytest.approx(walk(scene_of(LAWS["uncoupled"], approaches([-20.0]))).load[0], rel=1e-5)


def test_on_a_branch_without_a_jump_there_is_no_hysteresis():
    found = walk(scene_of(NormalCohesiveZone(0.4), along(-10, 2, 0.2) >> along(1.8, -10, 0.2)))
    assert not found.jumps
    assert np.allclose(found.load, found.load[::-1], rtol=1e-5, atol=1e-6)


def test_increments_longer_than_the_trust_radius_need_no_damped_flow_after_the_first_states():
    found = walk(scene_of(LAWS["uncoupled"], along(-10, 10, 0.25)))
    flowed = [state for state in found.states if state.iterations > NewtonKrylov.newton_budget]
    assert len(flowed) <= 6  # the first states and those around the jump


# ---- load control


@pytest.mark.parametrize("body", [LAYER, HalfSpace(77.0, 0.3), Layer(93.0, 0.5, 5000.0)], ids=repr)
@pytest.mark.parametrize("name", LAWS)
def test_prescribing_the_load_of_an_approach_gives_that_approach(name, body):
    moved = walk(scene_of(LAWS[name], along(-10, 7, 0.2), body))
    kept = [count for count, state in enumerate(moved.states) if state.step.value >= 1]
    loads = pressures((moved.load[kept] / LENGTH).tolist())
    loaded = walk(scene_of(LAWS[name], loads, body))
    assert loaded.statuses == {"CONVERGED"}
    assert not loaded.jumps
    for count, state in zip(kept, loaded.states, strict=True):
        here = loaded.problem.at(state.step)
        found = here.mean_displacement - state.displacement[0, 0].real
        # the residual 1e-7 of the strength over the contact's stiffness, some 1e-3 GPa/nm
        assert found == pytest.approx(moved.states[count].step.value, abs=1e-4)
    assert np.allclose(loaded.load, moved.load[kept], rtol=1e-5, atol=1e-3)


@pytest.mark.parametrize("kind", PATH[:1] + PATH[2:])
def test_a_load_beyond_pull_off_is_reported_and_the_path_ends(kind):
    loads = [LoadStep(Trait.MEAN_PRESSURE, value / LENGTH) for value in (200.0, -1000.0, 200.0)]
    found = walk(scene_of(LAWS["uncoupled"], LoadPath(tuple(loads))), method=kind)
    assert [state.status for state in found.states] == [Status.CONVERGED, Status.NO_EQUILIBRIUM, Status.SKIPPED]
    here = found.problem.at(loads[1])
    assert here.gap(found.states[1].displacement)[0].min() > SEPARATION * here.interaction_range


@pytest.mark.parametrize("name", ["coupled", "uncoupled"])
def test_slip_presses_bodies_through_each_other_only_where_it_takes_the_repulsion(name):
    law = CohesiveZone(2.0, 1.0) if name == "coupled" else UncoupledCohesiveZone(2.0, 1.0)
    (load,) = pressures([0.1 * law.strength]).steps
    far, farther = (LoadStep(Trait.SLIDE, slide, held=load) for slide in (12.0, 24.0))
    path = LoadPath((load, far, farther))
    found = walk(Scene(Body(Flat(LENGTH)), Body(Flat(LENGTH), HalfSpace(1e5, 0.3)), (law,), path), points=16)
    ends = (Status.NO_EQUILIBRIUM, Status.SKIPPED) if name == "coupled" else (Status.CONVERGED, Status.CONVERGED)
    assert [state.status for state in found.states] == [Status.CONVERGED, *ends]


class _Springs(NormalCohesiveZone):
    """Springs of 1 GPa/nm, which repel in proportion to the overlap."""

    def traction(self, gap):
        return gap[:1]


def test_deep_overlap_carries_a_load_where_it_repels_no_more_than_that_load():
    scene = scene_of(_Springs(1.0), pressures([50.0]))
    problem = pose_cohesive(scene, scene.heights(16), 1e-6).at(scene.path.steps[0])
    assert not cannot_carry_load(problem, np.full((1, 16), -50.0))
    assert cannot_carry_load(problem, np.full((1, 16), -1000.0))


# ---- limits of bodies and grids, and honest ends


@pytest.mark.parametrize("ratio", [-0.5, 0.5])
@pytest.mark.parametrize("name", LAWS)
def test_auxetic_and_incompressible_layers_are_solved(name, ratio):
    result = walk(scene_of(LAWS[name], along(-10, 8, 0.5), Layer(93.0, ratio, 5000.0)), points=128)
    assert result.statuses == {"CONVERGED"}
    for state in (result.states[0], result.states[-1]):
        assert residual_of(result.problem.at(state.step), state.displacement) <= 1e-7


@pytest.mark.parametrize("points", [2, 3, 4, 7, 16, 31])
def test_any_number_of_points_has_an_answer(points):
    found = walk(scene_of(LAWS["frictional"], along(-10, 5, 0.5)), points)
    assert found.statuses == {"CONVERGED"}
    assert np.isfinite(found.load).all()


def test_a_process_zone_below_the_grid_ends_honestly():
    scene = scene_of(CohesiveZone(1e5), along(-10, -9, 0.5))
    found = walk(scene, points=128, method=NewtonKrylov(flow_budget=100))
    assert found.statuses <= {"CONVERGED", "MAX_ITERATIONS", "SKIPPED"}
    for state in found.states:
        solved = residual_of(found.problem.at(state.step), state.displacement) <= 1e-7
        assert solved == (state.status is Status.CONVERGED)


@pytest.mark.parametrize("kind", PATH)
def test_a_solver_out_of_iterations_says_so_and_the_path_ends(kind):
    short = {"newton": {"newton_budget": 1, "flow_budget": 1}}.get(kind, {"budget": 1})
    found = walk(scene_of(LAWS["uncoupled"], along(-5.5, -4.5, 0.25)), method=make_solver(kind, **short))
    assert [state.status for state in found.states] == [Status.MAX_ITERATIONS] * 3 + [Status.SKIPPED] * 2
    assert found.states[0].residual > 1e-7
    assert np.isnan(found.states[3].residual)


class Refusing(NewtonKrylov):
    """Newton's method that finds nothing at some approaches."""

    refused = (-4.75, -4.5)

    def solve_near(self, problem, guess, memory, within=np.inf):
        return self._spoiled(problem, super().solve_near(problem, guess, memory, within))

    def flow_from(self, problem, start):
        return self._spoiled(problem, super().flow_from(problem, start))

    def _spoiled(self, problem, found):
        return replace(found, status=Status.MAX_ITERATIONS) if problem.approach in self.refused else found


def test_a_path_goes_on_from_the_last_stable_state_where_a_step_has_no_solution():
    scene = scene_of(LAWS["uncoupled"], along(-5.5, -4, 0.25))
    found, whole = walk(scene, method=Refusing()), walk(scene)
    lost = [state.step.value in Refusing.refused for state in found.states]
    assert [state.status is Status.MAX_ITERATIONS for state in found.states] == lost
    assert np.abs(found.load - whole.load)[~np.array(lost)].max() <= 1e-5 * np.abs(whole.load).max()


def test_dynamics_that_diverge_are_reported():
    # far beyond touch the law is stiffer than its stiffness says, and than the time step can follow
    found = walk(scene_of(NormalCohesiveZone(2.0), approaches([60.0])), method="damped_verlet")
    assert found.states[0].status is Status.NON_FINITE


def test_work_is_counted_in_transforms():
    scene = scene_of(LAWS["frictional"])
    problem = pose_cohesive(scene, scene.heights(64), 1e-13).at(LoadStep(Trait.APPROACH, -8.0))
    found = make_solver("damped_verlet", batch=10, budget=3).flow_from(problem, np.zeros(problem.unknowns, complex))
    assert found.iterations == 30
    # four for each of 30 steps, for each of 4 checks and their 2, and 2 for how far it moved
    assert problem.counter.transforms == 4 * 30 + 4 * (4 + 2) + 2


def test_adaptive_increments_need_a_solver_that_predicts():
    with pytest.raises(InputError, match=r"^increments: got 'adaptive'; allowed: requested"):
        walk(scene_of(LAWS["uncoupled"], JUMP), method="damped_verlet", increments=Adaptive())


@pytest.mark.parametrize(
    "options", [{"error": 0.0}, {"least": -1.0}, {"most": float("nan")}, {"least": 2.0, "most": 1.0}]
)
def test_increments_out_of_range_are_refused(options):
    with pytest.raises(InputError, match=rf"^{next(iter(options))}: .* (needs a positive number|allowed: at most)"):
        Adaptive(**options)


@pytest.mark.parametrize(
    "path",
    [
        along(-10, 5, 0.5) >> approaches([5.0, 5.0]) >> along(4.5, -9, 0.5),
        along(-10, 5, 0.5) >> approaches([-2.0]) >> along(5.5, 7, 0.5),
        approaches([-3.0]),
        approaches([-3.0, -3.0]),
    ],
    ids=["hold", "one step back", "one step", "one step held"],
)
def test_adaptive_increments_go_wherever_the_path_goes(path):
    scene = scene_of(LAWS["uncoupled"], path)
    asked, adaptive = walk(scene), walk(scene, increments=Adaptive())
    assert adaptive.statuses <= {"CONVERGED", "INTERPOLATED"}
    # on loading the jump lies within one of the increments asked for
    assert np.abs(adaptive.load - asked.load).max() <= 2e-3 * np.abs(asked.load).max()
    assert [state.step.value for state in adaptive.states] == [step.value for step in path.steps]


def test_requested_states_a_rounding_error_from_computed_ones_are_interpolated_safely():
    scene = scene_of(LAWS["uncoupled"], sweep(Trait.MEAN_PRESSURE, [0.0, 0.05], 0.001))
    asked, adaptive = walk(scene), walk(scene, increments=Adaptive(least=1e-5, most=0.02))
    near = walk(scene, increments=Adaptive(least=0.01, most=1.0))  # its shortest increment is ten of those asked for
    for found in (adaptive, near):
        assert found.statuses <= {"CONVERGED", "INTERPOLATED"}
    assert np.abs(adaptive.load - asked.load).max() <= 1e-4 * np.abs(asked.load).max()
    assert np.abs(near.load).max() <= 1.01 * np.abs(asked.load).max()


def test_a_change_of_control_starts_a_leg():
    path = along(-10, 5, 0.5) >> pressures([0.006, 0.008, 0.01])
    asked = walk(scene_of(LAWS["uncoupled"], path))
    adaptive = walk(scene_of(LAWS["uncoupled"], path), increments=Adaptive(least=1e-5, most=1.0))
    assert adaptive.statuses <= {"CONVERGED", "INTERPOLATED"}
    assert np.abs(adaptive.load - asked.load)[-3:].max() <= 1e-4 * asked.load.max()


def test_the_residual_of_an_interpolated_state_is_what_its_displacement_leaves_unbalanced():
    for name in LAWS:
        for path in (along(-10, 5, 0.13), along(-10, 0, 0.5) >> pressures(np.linspace(0.0, 0.01, 40).tolist())):
            found = walk(scene_of(LAWS[name], path), increments=Adaptive(least=1e-4, most=1.0))
            between = [state for state in found.states if state.status is Status.INTERPOLATED]
            assert between
            for state in between[::5]:
                unbalanced = residual_of(state.problem, state.displacement)
                assert state.residual == pytest.approx(unbalanced, rel=0.02, abs=3e-7)
                assert 1e-7 < state.residual < 0.02


@pytest.mark.parametrize("increment", [0.1, 0.5, 2.0, 5.0])
@pytest.mark.parametrize("name", LAWS)
def test_a_jump_is_found_within_any_increment(name, increment):
    path = along(-10, 10, increment) >> along(10 - increment, -15, increment)
    fine = walk(scene_of(LAWS[name], along(-10, 10, 0.1) >> along(9.9, -15, 0.1)))
    found = walk(scene_of(LAWS[name], path))
    assert found.statuses == {"CONVERGED"}
    assert len(found.jumps) == len(fine.jumps) == 2
    sizes = [[state.jump for state in one.states if state.jump] for one in (fine, found)]
    assert np.allclose(*sizes, rtol=0.02)
    for way, place, near in zip((1, -1), fine.jumps, found.jumps, strict=True):
        assert -0.1 - 1e-9 <= way * (near - place) <= increment + 1e-9


def test_a_large_retraction_stays_in_contact_where_small_steps_hold_it():
    held = along(-10, 2, 0.2) >> approaches([-7.0])
    fine = along(-10, 2, 0.2) >> along(1.8, -7, 0.2)
    at_once, slowly = (walk(scene_of(LAWS["uncoupled"], path)) for path in (held, fine))
    assert at_once.load[-1] == pytest.approx(slowly.load[-1], rel=1e-5)
    assert at_once.load[-1] < 10 * walk(scene_of(LAWS["uncoupled"], approaches([-7.0]))).load[0] < 0
    assert not at_once.states[-1].jump


@pytest.mark.parametrize("increment", [0.5, 4.0, 16.0])
def test_all_jumps_within_an_increment_are_found(increment):
    heights = np.array([0.0, -3.1, -6.4, -10.2, -12.9])
    surface = Sinusoids(LENGTH, 10.0, heights)
    sums = []
    for step in (0.1, increment):
        path = along(-16, 16, step) >> along(16 - step, -16, step)
        found = walk(scene_of(NormalCohesiveZone(2.0), path, HalfSpace(77.0, 0.3), surface=surface))
        jumps = np.array([state.jump for state in found.states])
        turn = int(np.argmax([state.step.value for state in found.states])) + 1
        sums.append([jumps[:turn].sum(), jumps[turn:].sum(), found.load[turn - 1]])
    assert sums[0][0] > 15
    assert np.allclose(*sums, rtol=0.15)  # the smallest may happen smoothly


@dataclass(frozen=True)
class Sinusoids(Flat):
    """Asperities of one amplitude (nm) and of heights (n,), nm, side by side."""

    amplitude: float = 10.0
    tops: np.ndarray | None = None

    def __init__(self, length, amplitude, tops):
        object.__setattr__(self, "length", length)
        object.__setattr__(self, "amplitude", amplitude)
        object.__setattr__(self, "tops", tops)
        object.__setattr__(self, "height", 0.0)

    def heights(self, points):
        place = np.arange(points) * len(self.tops) / points
        return self.amplitude * np.cos(2 * np.pi * place) - self.amplitude + self.tops[(place + 0.5).astype(int) % 5]


def test_a_path_that_changes_its_control_goes_on_from_its_last_state():
    held = along(-10, 2, 0.2) >> along(1.8, -9, 0.2)
    whole = walk(scene_of(LAWS["uncoupled"], held))
    pressure = whole.load[-1] / LENGTH
    found = walk(scene_of(LAWS["uncoupled"], held >> pressures([0.9 * pressure])))
    other = walk(scene_of(LAWS["uncoupled"], held >> pressures([0.9 * pressure]) >> along(2.0, 3.0, 0.2)))
    state = found.states[-1]
    assert state.status is Status.CONVERGED
    assert found.load[-1] == pytest.approx(0.9 * whole.load[-1], rel=1e-5)
    back = walk(scene_of(LAWS["uncoupled"], along(-10, 3, 0.2)))
    assert other.load[-1] == pytest.approx(back.load[-1], rel=1e-5)
    # a load that this state carries, but no stable one near it: the jump is told, at once
    assert state.jump > 1
    small = walk(scene_of(LAWS["uncoupled"], held >> pressures([share * pressure for share in (0.999, 0.99, 0.9)])))
    assert [state.jump > 1 for state in small.states[-3:]] == [True, False, False]
