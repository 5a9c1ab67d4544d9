"""Paths followed on a coarse grid: their states on the full grid are solutions there; paths from first touch."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.contact import loading
from contactsim.contact.coarse_grid import coarsen, prolong
from contactsim.contact.loading import LoadPath, approaches
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.half_space import FreeHalfSpace, HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.hard_wall import HardWall
from contactsim.observables.conformity import conformities, first_short_mode
from contactsim.paths.continuation import Continuation
from contactsim.paths.nested import Nested
from contactsim.paths.state import PathState
from contactsim.simulation import simulate
from contactsim.solvers.registry import make_solver
from contactsim.status import Status
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.plan import Plan
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait
from support.places import ROOT
from support.smooth import LAWS, Walked, along, residual_of, scene_of, walk

ROUGH_LAWS = {
    "normal": NormalCohesiveZone(10.5),
    "coupled": CohesiveZone(10.5),
    "frictional": CohesiveZone(10.5, 0.5),
    "uncoupled_frictional": UncoupledCohesiveZone(10.5, 0.5),
}
FULL = [-4.0, 0.0, 3.0]


def rough(points: float = 32.0) -> SelfAffine:
    """A rough profile whose shortest wave is so many of 4096 points long."""
    length = 2560.0
    return SelfAffine(length, 0.8, 320.0, points * length / 4096, rms_height=5.0, seed=realisation_seed(7, 0.8))


def rough_scene(law: object, begin: float = -5.0, end: float = 3.0) -> Scene:
    body = HalfSpace(70 / (1 - 0.3**2), 0.3)
    path = loading.sweep(Trait.APPROACH, [begin, end], 0.5, from_touch=True)
    return Scene(Body(Flat.facing(rough()), body), Body(rough()), (law,), path)


def on_grid(found: Walked, points: int) -> list:
    return [state for state in found.states if state.points == points]


@pytest.mark.parametrize("name", ROUGH_LAWS)
def test_states_on_the_full_grid_are_those_of_a_path_on_the_full_grid(name):
    scene = rough_scene(ROUGH_LAWS[name])
    whole = walk(scene, points=4096)
    nested = walk(scene, points=4096, increments=Nested(FULL))
    assert nested.statuses == whole.statuses == {"CONVERGED"}
    found = on_grid(nested, 4096)
    assert [state.step.value for state in found] == FULL
    assert max(state.residual for state in found) <= 1e-7
    assert nested.transforms < whole.transforms / 3  # measured: 5 to 9 times fewer
    places = [state.points == 4096 for state in nested.states]
    wrong = np.abs(nested.load - whole.load) / np.abs(whole.load).max()
    assert wrong[places].max() <= 1e-6
    # a jump may come an increment sooner on the coarse grid; the other states are solved to 1e-4 on 1024 points
    assert (wrong > 3e-4).sum() <= 1


def test_a_state_on_the_full_grid_is_certified_from_its_displacement_alone():
    nested = walk(rough_scene(ROUGH_LAWS["normal"]), points=4096, increments=Nested(FULL))
    for state in on_grid(nested, 4096):
        assert residual_of(nested.problem.at(state.step), state.displacement) <= 1e-7
    others = [state for state in nested.states if state.points == 1024]
    assert len(others) == len(nested.states) - len(FULL)
    for state in others:
        assert residual_of(state.problem, state.displacement) <= 1e-4
        assert [field.shape for field in state.fields()] == [(1, 1024)] * 2


def test_fields_kept_are_those_of_the_whole_grid_wherever_a_state_was_solved():
    scene = rough_scene(ROUGH_LAWS["coupled"], end=0.0)
    data = simulate(scene, points=4096, tolerance=1e-7, increments=Nested([0.0]), snapshots=[-1.0, 0.0])
    assert data.normal_gap.shape == (2, 4096)
    assert data.solved_points.values.tolist() == [1024] * 9 + [4096]
    assert data.transforms.sum() > 0 and (data.status == 0).all()
    datum = data.normal_gap + data.normal_displacement + data.heights  # what both leave is the approach
    assert abs(datum + data.snapshot + data.approach_first_touch).max() < 1e-9


def rough_surface(length: float = 512.0) -> SelfAffine:
    """A rough surface whose shortest wave is eight of 128 points long."""
    seed = realisation_seed(3, 0.8)
    return SelfAffine(length, 0.8, length / 2, length / 16, rms_height=3.0, seed=seed, dimensions=2)


def test_on_a_surface_states_on_the_full_grid_are_those_of_a_path_on_the_full_grid():
    law, full = NormalCohesiveZone(0.1), [-12.0, -4.0, -16.0]
    path = approaches([-14.0, -4.0, -16.0], 1.0)
    scene = Scene(HalfSpace(1.0), rough_surface(), law, path)
    whole, nested = (
        simulate(scene, points=128, tolerance=1e-6, increments=increments)
        for increments in (None, Nested(full, coarse_ratio=4, intermediate_ratio=2))
    )
    assert set(nested.status.values) == set(whole.status.values) == {Status.CONVERGED.value[0]}
    is_full = nested.solved_points.values == 128**2
    assert is_full.tolist() == [step.value in full for step in path.steps]
    assert set(nested.solved_points.values[~is_full]) == {64**2}
    assert nested.residual.values[is_full].max() <= 1e-6
    wrong = np.abs(nested.normal_force - whole.normal_force).values / np.abs(whole.normal_force).values.max()
    assert wrong[is_full].max() < 1e-5
    assert np.median(wrong[~is_full]) < 0.02  # four points for the shortest wave
    assert float(nested.transforms.sum()) < float(whole.transforms.sum()) / 2


def test_grids_are_not_nested_where_heights_do_not_repeat():
    path = approaches([-2.0, 0.0], 1.0)
    scene = Scene(FreeHalfSpace(1.0), rough_surface(), NormalCohesiveZone(0.1), path)
    with pytest.raises(InputError, match="as the heights do not repeat") as caught:
        simulate(scene, points=64, increments=Nested([0.0], coarse_ratio=4))
    assert caught.value.key == "increments"


@pytest.mark.parametrize("name", ["normal", "coupled"])
def test_waves_are_followed_as_the_stored_gap_says(name):
    scene = rough_scene(ROUGH_LAWS[name], end=0.0)
    data = simulate(scene, points=4096, tolerance=1e-7, increments=Nested([0.0]), snapshots=[0.0])
    before, after = (np.fft.rfft(values) for values in (-data.heights.values, data.normal_gap.values[0]))
    first = first_short_mode(before)
    assert 8 < first < 128  # of waves with 8 to 128 in a period
    expected = conformities(before, after, first)
    for number, value in expected.items():
        assert float(data[number][-1]) == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_a_coarser_problem_is_the_one_posed_on_fewer_points(name):
    scene = scene_of(LAWS[name], along(0, 1, 1), surface=rough(256.0))
    whole = pose_cohesive(scene, scene.heights(512), 1e-7)
    coarse, posed = coarsen(whole, 8, 1e-3), pose_cohesive(scene, scene.heights(64), 1e-3)
    assert coarse.tolerance == 1e-3 and coarse.unknowns == posed.unknowns
    assert np.allclose(coarse.stiffness.diagonal[:, :-1], posed.stiffness.diagonal[:, :-1], rtol=1e-12)
    if posed.slip_factor is None and len(posed.shape) == 2:
        assert np.allclose(coarse.stiffness.coupling, posed.stiffness.coupling, rtol=1e-12)
    if posed.slip_factor is not None:
        assert np.allclose(coarse.slip_factor, posed.slip_factor, rtol=1e-12)
    assert np.allclose(coarse.shape, posed.shape, atol=1e-12 * np.ptp(posed.shape))
    assert prolong(whole, coarse.grid, np.ones(coarse.unknowns)).sum() == coarse.unknowns[0] * 32


def test_a_half_space_and_a_layer_from_first_touch_are_the_same_paths_as_from_the_mean_plane():
    top = float(rough().heights(512).max())
    for law, body in ((NormalCohesiveZone(2.0), HalfSpace(70.0)), (HardWall(), Layer(70.0, 0.3, 1000.0))):
        absolute = loading.approaches([value - top for value in (-1.0, 0.5, 2.0)])
        from_touch = LoadPath(loading.approaches([-1.0, 0.5, 2.0]).steps, from_touch=True)
        one, two = (
            simulate(Scene(Body(Flat.facing(rough()), body), Body(rough()), (law,), path), points=512)
            for path in (absolute, from_touch)
        )
        assert one.approach_first_touch == two.approach_first_touch == pytest.approx(-top)
        names = ["approach", "line_load"] if "line_load" in one else ["mean_pressure", "relative_contact_area"]
        for name in names:
            assert np.allclose(one[name], two[name], rtol=1e-6, atol=1e-12), name


def test_parts_of_a_path_count_from_the_same_place():
    with pytest.raises(InputError, match="from_touch") as caught:
        loading.approaches([1.0]) >> LoadPath(loading.approaches([2.0]).steps, from_touch=True)
    assert caught.value.key == "from_touch"


@pytest.mark.parametrize(
    ("options", "key"),
    [
        ({"coarse_ratio": 3}, "coarse_ratio"),
        ({"coarse_ratio": 2}, "intermediate_ratio"),
        ({"coarse_tolerance": 0.0}, "coarse_tolerance"),
        ({"intermediate_ratio": 0}, "intermediate_ratio"),
    ],
)
def test_impossible_options_are_refused(options, key):
    with pytest.raises(InputError) as caught:
        Nested([0.0], **options)
    assert caught.value.key == key


def test_a_ratio_that_leaves_no_even_grid_is_refused():
    scene = scene_of(LAWS["uncoupled"], along(0, 1, 1))
    problem = pose_cohesive(scene, scene.heights(72), 1e-7)
    with pytest.raises(InputError, match="half the grid's 72 points"):
        list(Nested([0.0]).follow(problem, make_solver("newton"), scene.path.steps))


def test_a_value_for_the_full_grid_that_is_no_step_is_refused():
    scene = rough_scene(ROUGH_LAWS["normal"])
    with pytest.raises(InputError, match="steps of the path") as caught:
        walk(scene, points=4096, increments=Nested([0.0, 0.3]))
    assert (caught.value.key, caught.value.value) == ("full_grid_at", [0.3])


def test_a_tolerance_that_doing_nothing_would_meet_is_refused():
    scene = scene_of(LAWS["uncoupled"], along(0, 1, 1))
    with pytest.raises(InputError, match=r"at most 0[.]1") as caught:
        pose_cohesive(scene, scene.heights(64), 10.0)
    assert caught.value.key == "tolerance"


def test_a_path_that_was_killed_and_begun_again_is_the_same_byte_for_byte(tmp_path, monkeypatch):
    """States depend on those before, so a path begins anew; nothing of the first try is left to change it."""
    run = next(iter(Plan.read(ROOT / "config", "quick").studies["rough_adhesive_64"].runs()))
    settings = run.settings | {"points": 2048, "snapshots": [8.0]}
    settings["load"] = settings["load"] | {"through": [-7.0, 8.0]}
    settings["increments"] = settings["increments"] | {"full_grid_at": [-4.0, 2.0, 8.0]}
    whole, again = (RunFiles(tmp_path / f"{name}.nc", tmp_path / f"{name}.json") for name in ("whole", "again"))
    execute.run(settings, run.source, whole)
    advance, steps = Continuation.advance, []

    def killed(self: Continuation, step: LoadStep) -> PathState:
        """Five states, then none."""
        steps.append(step)
        if len(steps) > 5:
            raise KeyboardInterrupt
        return advance(self, step)

    with monkeypatch.context() as patch:
        patch.setattr(Continuation, "advance", killed)
        with pytest.raises(KeyboardInterrupt):
            execute.run(settings, run.source, again)
    assert not list(tmp_path.glob("*again*"))
    execute.run(settings, run.source, again)
    assert again.data.read_bytes() == whole.data.read_bytes()
