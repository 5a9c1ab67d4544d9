"""What a scene does not list is not there: no fields, no work, no storage."""

from __future__ import annotations

import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from contactsim.contact import loading
from contactsim.contact.pose_hard_wall import pose_hard_wall
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.errors import InputError
from contactsim.explanation import Explanation, explain_setup
from contactsim.figures.sketch import save_sketch
from contactsim.interface.hard_wall import HardWall
from contactsim.paths.options import RunOptions, Setup
from contactsim.simulation import simulate
from contactsim.solvers.base import solve
from contactsim.solvers.registry import make_solver
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid, Sphere
from support.cases import ALL, press, rough

WALL = (HardWall(),)


def scene(lower=None, upper=None, effects=WALL, path=None):
    lower = lower or Body(Flat(64.0), HalfSpace(1.0))
    return Scene(lower, upper or Body(Sinusoid(64.0, 1.0)), effects, path or loading.pressures([0.02]))


def solved(subject, points=256, name="active_set"):
    problem, scale = pose_hard_wall(subject, subject.path.steps[0], subject.heights(points), 1e-6, 1)
    return solve(make_solver(name), problem, scale)


def explained(subject: Scene, points: int = 256, name: str = "active_set") -> Explanation:
    return explain_setup(Setup(subject, RunOptions(points, solver=make_solver(name))))


def test_a_wall_alone_has_one_component():
    assert scene().components == ("n",)
    result = solved(scene())
    assert result.pressure.shape == result.gap.shape == (256,)


def test_a_scene_in_which_nothing_resists_overlap_is_refused():
    with pytest.raises(InputError, match="resists overlap"):
        scene(effects=())


def test_a_scene_in_which_nothing_gives_way_is_refused():
    with pytest.raises(InputError, match="elastic body"):
        scene(lower=Body(Flat(64.0)))


def test_bodies_of_different_period_are_refused():
    with pytest.raises(InputError, match="the same periods"):
        scene(upper=Body(Flat(65.0)))


def test_a_rigid_body_is_absent_from_the_compliance():
    grid_q = np.linspace(0, 3, 10)
    assert np.array_equal(scene().compliance(grid_q), HalfSpace(1.0).compliance(grid_q))
    assert scene().contact_modulus == 1.0


def test_two_bodies_of_equal_modulus_are_one_of_half_modulus_against_a_rigid_one():
    both = scene(Body(Flat(64.0), HalfSpace(2.0)), Body(Sinusoid(64.0, 1.0), HalfSpace(2.0)))
    assert np.allclose(solved(both).pressure, solved(scene()).pressure, rtol=1e-12)


def test_only_the_sum_of_the_heights_matters():
    shared = scene(Body(Sinusoid(64.0, 0.4), HalfSpace(1.0)), Body(Sinusoid(64.0, 0.6)))
    assert np.allclose(solved(shared).pressure, solved(scene()).pressure, rtol=1e-9)


@pytest.mark.parametrize("name", ALL)
def test_no_load_costs_one_application_of_the_compliance_and_no_iteration(name):
    result = solved(scene(path=loading.pressures([0.0])), name=name)
    assert (result.record.iterations, result.record.transforms) == (0, 2.0)


def test_complete_contact_costs_next_to_nothing():
    assert press(0.01 * rough(4096), 1.0).record.transforms < 20


@pytest.mark.parametrize("name", ALL)
def test_peak_memory_is_the_few_fields_that_are_explained(name):
    points = 2**15
    method = make_solver(name) if name == "active_set" else make_solver(name, budget=2)
    heights = rough(points)

    def peak(pressure):
        tracemalloc.start()
        press(heights, pressure, method)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    # What is imported or cached once counts as memory too, so the same load is pressed again.
    peaks = [min(peak(pressure) for _ in range(3)) for pressure in (1e-3, 0.1, 0.3, 1.0)]
    expected = 1e6 * explained(scene(path=loading.pressures([0.1])), points, name).megabytes
    assert 0.9 * expected < max(peaks) < expected  # two more fields would be seen


PRESS_A_SURFACE = """
import sys
from contactsim.contact import loading
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.interface.hard_wall import HardWall
from contactsim.simulation import simulate
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed
from contactsim.surfaces.shapes import Flat

def peak():  # of this program alone: what getrusage tells begins with its parent's
    return float(open("/proc/self/status").read().partition("VmHWM:")[2].split()[0])

for points in (256, 2048):  # the smaller one makes the threads and their buffers
    rough = SelfAffine(points, 0.8, points / 4, 8.0, 1.0, seed=realisation_seed(1, 0.8), dimensions=2)
    path = loading.pressures([1e-3, 1e-2])
    scene = Scene(Body(Flat.facing(rough), HalfSpace(1.0)), Body(rough), (HardWall(),), path)
    before = peak()
    simulate(scene, points=points, threads=int(sys.argv[1]), keep=["contact"])
print((peak() - before) * 2**10 / points**2 / 8)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="memory is read where Linux tells it")
@pytest.mark.parametrize("threads", [1, 2])
def test_a_run_of_a_surface_never_holds_more_than_the_fields_that_are_explained(threads):
    command = [sys.executable, "-c", PRESS_A_SURFACE, str(threads)]
    peak = float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    most = make_solver("conjugate_gradients").fields
    assert 0.8 * most < peak < most  # doubles a point, of the whole process, the libraries' own memory included


@pytest.mark.parametrize("name", ALL)
def test_an_iteration_takes_the_transforms_that_are_explained(name):
    subject = scene()
    points, counts = 512, []
    batch = {"active_set": "inner_budget", "polonsky_keer": "batch", "verlet": "batch"}[name]
    for iterations in (2, 5):  # so few that none of them ends with its set solved
        alone = {"coarsest": points, "reduction": 1e-12, "direct_points": 0} if name == "active_set" else {}
        method = make_solver(name, **{batch: iterations, "budget": 1}, **alone)
        problem, scale = pose_hard_wall(subject, subject.path.steps[0], rough(points), 1e-12, 1)
        counts.append(solve(method, problem, scale).record.transforms)
    assert (counts[1] - counts[0]) / 3 == explained(subject, points, name).transforms


def test_what_is_not_listed_is_not_stored():
    data = simulate(scene(), points=256)
    assert set(data.dims) == {"step", "byte", "contact_point", "mode"}  # no component axis: there is one
    assert not [name for name in data if "tangential" in str(name) or "shear" in str(name)]


def test_an_explanation_says_what_is_on_what_is_not_and_who_may_solve_it():
    explanation = explained(scene())
    assert explanation.fields == ("normal displacement", "normal traction")
    assert explanation.missing["tangential displacement and traction"] == "no effect reads or exerts them"
    assert explanation.missing["deformation of the upper body"] == "it is rigid"
    assert explanation.unknowns == 256
    assert {name: explanation.solvers[name] for name in ALL} == dict.fromkeys(ALL, "")
    moved = explained(scene(path=loading.approaches([-0.5])))
    assert "approach" in moved.solvers["verlet"]
    assert "verlet: not made for load step given by an approach" in moved.text
    both = scene(Body(Flat(64.0), HalfSpace(2.0)), Body(Sinusoid(64.0, 1.0), HalfSpace(2.0)))
    assert "the second displacement field" in explained(both).missing


def test_a_smooth_scene_asks_for_no_random_numbers():
    first, second = (Cylinder(4.0, 1.0).heights(64) for _ in range(2))
    assert np.array_equal(first, second)


def test_a_surface_is_explained_by_all_its_points_and_drawn_through_its_middle(tmp_path):
    ball = Sphere(64.0, 100.0)
    subject = Scene(Body(Flat.facing(ball), HalfSpace(1.0)), Body(ball), (HardWall(),), loading.pressures([1e-3]))
    explanation = explained(subject, 32, "conjugate_gradients")
    assert explanation.unknowns == 32 * 32
    assert explanation.megabytes == pytest.approx(32 * 32 * 8 * make_solver("conjugate_gradients").fields / 1e6)
    save_sketch(subject, 32, tmp_path / "sketch.png")
    assert (tmp_path / "sketch.png").stat().st_size > 0
