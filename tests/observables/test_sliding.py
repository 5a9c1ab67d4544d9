"""Paths that press and slide: exact flats, slips and their place, loops, loads, and what is read off a slide."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import xarray as xr

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadPath, sweep
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep, Slide
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.evaluation.work_precision.knobs import summarise_solutions
from contactsim.interface.cohesive_zone import CohesiveZone
from contactsim.interface.lattice import Lattice
from contactsim.observables import friction, peeling, polyline, sliding, threshold
from contactsim.observables.derived import combine_runs
from contactsim.paths.increments import INCREMENTS
from contactsim.paths.requested import Requested
from contactsim.paths.state import PathState
from contactsim.reference import springs
from contactsim.simulation import simulate
from contactsim.solvers.registry import make_solver
from contactsim.surfaces.shapes import Cylinder, Flat
from contactsim.traits import Trait

LATTICE = 5000 / 2048
RATIO = 0.45
HELD = LoadStep(Trait.APPROACH, 0.0)


def path_of(approach: float, slides: list[float], increment: float, load: float | None = None) -> LoadPath:
    press = sweep(Trait.APPROACH, [-10.0, approach], 0.5, True)
    if load is not None:
        press = press >> LoadPath((LoadStep(Trait.MEAN_PRESSURE, load),), True)
    return press >> LoadPath((Slide(tuple(slides), increment, press.steps[-1]),), True)


def flat(modulus: float, work: float, slides: list[float], increment: float = 0.1, points: int = 16) -> Scene:
    surface = Flat(length=100.0)
    body = Layer(modulus / (1 - RATIO**2), RATIO, 500.0)
    law = CohesiveZone(2.0, work / 2.0)
    path = path_of(0.0, slides, increment)
    return Scene(Body(Flat.facing(surface)), Body(surface, body), (law,), path, Lattice(LATTICE))


def probe(path: LoadPath, law: CohesiveZone | None = None, **changes: object) -> Scene:
    """A tenth of the probe of Chapter 6 in size, with a body as much softer and a lattice as before."""
    surface = Cylinder(length=1000.0, radius=2500.0)
    body = Layer(70.0 / (1 - RATIO**2), RATIO, 1000.0)
    law = law or CohesiveZone(2.0, 1.0)
    return Scene(Body(Flat.facing(surface)), Body(surface, body), (law,), path, Lattice(LATTICE, **changes))


def walked(
    scene: Scene, points: int = 16, method: object = "newton", increments: object = None
) -> tuple[CohesiveProblem, list[PathState], np.ndarray, np.ndarray]:
    """Problem, states on the slide, their slides (nm) and forces over the period (GPa)."""
    problem = pose_cohesive(scene, scene.heights(points), 1e-7)
    method = make_solver(method) if isinstance(method, str) else method
    states = list((increments or Requested()).follow(problem, method, scene.path.steps))
    assert {state.status.solved for state in states} == {True}
    states = [state for state in states if state.step.control is Trait.SLIDE]
    force = np.array([state.fields()[1][1].mean() for state in states])
    return problem, states, np.array([state.step.value for state in states]), force


FLATS = {"requested": Requested(), "adaptive": INCREMENTS["adaptive"](error=0.001)}


def exact(modulus: float, work: float, slides: np.ndarray) -> np.ndarray:
    return springs.uniform_slide(slides, modulus / (2 * (1 + RATIO)) / 500.0, work, LATTICE)


@pytest.mark.parametrize("increments", ["requested", "adaptive"])
@pytest.mark.parametrize(
    ("modulus", "work"), [(70.0, 0.2), (140.0, 0.2), (70.0, 0.1), (70.0, 0.02), (400.0, 0.1), (20.0, 0.4)]
)
def test_flats_slide_as_one_degree_of_freedom_slips_included(modulus, work, increments):
    _, states, slides, force = walked(flat(modulus, work, [0.0, 12.0]), increments=FLATS[increments])
    wanted = exact(modulus, work, slides)
    error = 1e-5 if increments == "requested" else 1e-3  # of tolerance and of interpolation
    np.testing.assert_allclose(force, wanted, atol=error * wanted.max())
    slipped = np.flatnonzero(np.diff(wanted) < -0.3 * wanted.max()) + 1
    found = [count for count, state in enumerate(states) if state.jump]
    if (modulus, work) in {(70.0, 0.2), (140.0, 0.2), (20.0, 0.4)}:
        assert found == slipped.tolist()


@pytest.mark.parametrize("lattice", [LATTICE, 2.0, 4.0])
@pytest.mark.parametrize(("beside", "slips"), [(0.99, True), (1.01, False)])
def test_stick_slip_ends_where_the_body_is_stiffer_than_the_springs_soften(lattice, beside, slips):
    work = 0.1
    places = np.linspace(0.0, lattice, 20001)
    sums = springs.spring_sum(places, lattice)[1]
    steepest = places[np.argmin(np.gradient(sums, places))]
    fall = springs.steepest_fall(lattice)
    stiffness = beside * work * fall
    about = steepest + work / stiffness * np.interp(steepest, places, sums)
    increment = 2e-4
    path = path_of(0.0, [0.0, about - 0.02], 0.05) >> LoadPath(
        (Slide((about - 0.02, about + 0.02), increment, HELD),), True
    )
    scene = replace(flat(stiffness * 2 * (1 + RATIO) * 500.0, work, [0.0, 1.0]), path=path, pairing=Lattice(lattice))
    _, _, slides, force = walked(scene)
    gap = slides - force / stiffness
    fastest = increment / (1 - 1 / 1.01)  # of a smooth slide of a body 1 % too stiff
    assert (np.diff(gap[-200:]).max() > 1.1 * fastest) == slips


@pytest.mark.parametrize("points", [8, 64])
def test_flats_do_not_depend_on_the_mesh(points):
    forces = [walked(flat(70.0, 0.2, [0.0, 6.0], 0.2, points), count)[3] for count in (16, points)]
    np.testing.assert_allclose(*forces, atol=1e-9)


def test_an_exact_slide_carries_what_the_springs_pull():
    slides = np.linspace(0, 12, 241)
    stiffness, strength = 0.05, 0.2
    force = springs.uniform_slide(slides, stiffness, strength, LATTICE)
    gap = slides - force / stiffness
    np.testing.assert_allclose(force, strength * springs.spring_sum(gap, LATTICE)[1], atol=1e-12)
    assert np.all(np.diff(gap) > 0)


@cache
def small_probe(
    increment: float = 0.1, points: int = 256, tangential_cutoff: float = 5.0, normal_cutoff: float = 40.0
) -> tuple:
    return walked(
        probe(path_of(0.0, [0.0, 11.0], increment), tangential_cutoff=tangential_cutoff, normal_cutoff=normal_cutoff),
        points,
    )


def places(states: list[PathState]) -> list[float]:
    return [jump.step.value for state in states for jump in state.jumps]


def test_a_probe_sticks_slips_by_one_lattice_constant_and_peels():
    problem, states, _, force = small_probe()
    slip = [count for count, state in enumerate(states) if state.jump]
    assert len(slip) >= 2
    gaps = [states[count].fields()[0] for count in (slip[0] - 1, slip[0])]
    middle = int(np.argmin(problem.shape[0]))
    assert (gaps[1][1, middle] - gaps[0][1, middle]) / LATTICE == pytest.approx(1.0, abs=0.15)
    contact = np.array([np.count_nonzero(state.fields()[0][0] < 0) for state in states])
    assert contact[slip[0] - 1] < contact[0]
    assert contact[slip[0]] > contact[slip[0] - 1]
    assert force[slip[0]] < force[slip[0] - 1]


@pytest.mark.parametrize(
    ("other", "error"),
    [
        ({"increment": 0.05}, 2e-3),
        ({"increment": 0.4}, 2e-2),
        ({"tangential_cutoff": 8.0}, 1e-6),
        ({"tangential_cutoff": 4.0}, 1e-6),
        ({"normal_cutoff": 1e6}, 1e-9),
        ({"normal_cutoff": 10.0}, 1e-3),
        ({"points": 512}, 1e-4),
    ],
)
def test_grid_increment_and_cutoffs_do_not_move_the_onset(other, error):
    forces, slips = zip(
        *((force.max(), places(states)[0]) for _, states, _, force in (small_probe(), small_probe(**other))),
        strict=True,
    )
    assert forces[1] == pytest.approx(forces[0], rel=error)
    assert slips[1] == pytest.approx(slips[0], abs=0.03)


@pytest.mark.parametrize("method", ["mass_weighted_verlet"])
def test_two_solvers_slide_alike(method):
    scene = probe(path_of(0.0, [0.0, 9.0], 0.25))
    (_, newton, _, force), (_, verlet, _, other) = (walked(scene, 128, name) for name in ("newton", method))
    np.testing.assert_allclose(other, force, atol=1e-4 * force.max())
    assert [bool(state.jump) for state in newton] == [bool(state.jump) for state in verlet]


def test_adaptive_increments_slide_alike_for_less():
    _, states, _, force = small_probe()
    scene = probe(path_of(0.0, [0.0, 11.0], 0.1))
    _, others, _, other = walked(scene, 256, increments=INCREMENTS["adaptive"]())
    np.testing.assert_allclose(other, force, atol=2e-3 * force.max())
    assert [state.step.value for state in others if state.jump] == [state.step.value for state in states if state.jump]
    np.testing.assert_allclose(places(others), places(states), atol=0.03)


def test_a_slide_under_a_load_carries_that_load():
    problem, states, _, _ = walked(probe(path_of(0.0, [0.0, 12.0], 0.2, 0.05)), 256)
    loads = [-state.fields()[1][0].mean() for state in states]
    np.testing.assert_allclose(loads, 0.05, atol=2e-7 * problem.strength)
    assert any(state.jump for state in states)


def test_a_slide_to_and_fro_is_antisymmetric_and_dissipates():
    scene = probe(path_of(0.0, [0.0, 10.0, -10.0, 10.0], 0.1))
    _, _, slides, force = walked(scene, 256)
    first, second = slice(101, 301), slice(301, 501)
    np.testing.assert_allclose(-force[first], force[second], atol=1e-4 * force.max())
    found = friction.summarise_slides(simulate(scene, solver="newton", points=256, tolerance=1e-7))
    assert float(found.loop_energy) > 100 * float(found.loop_energy_increment_error) > 0
    steps = np.diff(slides[first.start - 1 :])
    about = np.sum(steps * (force[first.start - 1 : -1] + force[first.start :]) / 2) * 1000.0
    assert float(found.loop_energy) == pytest.approx(about, rel=0.02)


def test_a_half_space_slides_by_its_mean():
    scene = probe(path_of(0.0, [0.0, 1.0], 0.5))
    upper = replace(scene.upper, elasticity=HalfSpace(70.0 / (1 - RATIO**2), RATIO))
    _, states, _, force = walked(replace(scene, upper=upper), 256)
    assert states[-1].fields()[0][1].mean() == pytest.approx(1.0)
    assert force[-1] > 0


@cache
def dataset_of(increment: float) -> xr.Dataset:
    """Of the slide up to its first slip, and a little on."""
    scene = probe(path_of(0.0, [0.0, 8.5], increment))
    return simulate(scene, solver="newton", points=256, tolerance=1e-7)


@cache
def dataset(**changes: object) -> xr.Dataset:
    scene = probe(path_of(0.0, [0.0, 11.0], 0.1), **changes)
    data = simulate(scene, solver="newton", points=256, tolerance=1e-7, snapshots=(0.0, 4.0))
    return data


def test_a_slide_becomes_a_dataset_with_its_slips():
    data = dataset()
    sliding_distance = data.sliding_distance.values
    assert np.isnan(sliding_distance[:20]).all()
    np.testing.assert_allclose(sliding_distance[20:], np.linspace(0, 11, 111), atol=1e-9)
    np.testing.assert_allclose(data.snapshot, [0.0, 4.0])
    found = friction.summarise_slides(data)
    told = found[[*sliding.EVENT, "event_periods"]].dropna("event")
    assert told.event.size == int(found.slip_count) >= 2
    assert float(found.first_slip_periods) == pytest.approx(1.0, abs=0.15)
    np.testing.assert_allclose(told.event_periods, 1.0, atol=0.15)
    np.testing.assert_allclose(np.diff(told.event_sliding_distance), LATTICE, atol=2e-3)
    np.testing.assert_array_less(told.event_width, 5e-4)
    assert (told.event_force_before > told.event_force_after).all()
    assert (told.event_released_energy > 0).all()
    assert (told.event_length_after > told.event_length_before).all()
    before = data.friction_force.values[20:]
    largest = before[: np.flatnonzero(data.jump.values[20:] > 0)[0]].max()
    assert largest <= float(found.static_friction) <= 1.005 * largest
    finer = friction.summarise_slides(dataset_of(0.0125)).static_friction
    assert abs(float(found.static_friction - finer)) <= float(found.static_friction_increment_error) < 1e-2 * largest
    assert 0 < float(found.onset_contact_length) < float(found.initial_contact_length)
    assert 0 < float(found.reattached_fraction) <= 1
    assert float(found.slip.max()) <= LATTICE / 2 + 1e-9


def test_the_increment_error_of_every_number_of_a_slide_is_known_and_covers_its_change_on_finer_increments():
    found, finer = (friction.summarise_slides(dataset_of(increment)) for increment in (0.05, 0.0125))
    for name in friction.ONSET:
        error = float(found[f"{name}_increment_error"])
        assert np.isnan(error) == np.isnan(float(found[name])), name
    for name in ("onset_contact_length", "reattached_fraction", "first_slip_released_energy", "contact_shift_halfway"):
        error = float(found[f"{name}_increment_error"])
        assert error > 0, name
        assert abs(float(found[name] - finer[name])) < 1.5 * error, name


def test_without_every_second_state_a_slide_keeps_its_ends_and_its_slips():
    states = {"sliding_distance": np.arange(6.0), "friction_force": np.arange(6.0) ** 2}
    events = {"event_step": np.array([3.0, 5.0, np.nan]), "event_width": np.full(3, 0.002)}
    odd, _ = polyline.every_second(states, events, 1)
    assert odd["sliding_distance"].tolist() == [0, 1, 3, 5]
    fewer, slips = polyline.every_second(states, events, 2)
    assert fewer["sliding_distance"].tolist() == [0, 2, 4, 5]
    assert slips["event_step"][:2].tolist() == [2, 3]  # before the states at 4 and 5, the next ones after each slip
    assert np.isnan(slips["event_step"][2])
    assert slips["event_width"] is events["event_width"]


def test_the_layer_stores_a_part_of_the_work_where_nothing_slips():
    data = dataset().isel(step=slice(20, 60))
    work = np.cumsum(
        np.diff(data.sliding_distance) * (data.friction_force.values[1:] + data.friction_force.values[:-1]) / 2
    )
    stored = data.elastic_energy.values[1:] - data.elastic_energy.values[0]
    assert (stored > 0).all()
    assert (stored < work).all()


def test_edges_lie_between_nodes_and_wrap_around():
    x = np.arange(64) * 1.0
    for shift in (0.0, 20.0, 32.0, 50.3):
        away = (x - shift + 32.0) % 64.0 - 32.0
        gap = away**2 - 5.3**2
        shape = away**2
        middle = away[np.argmin(shape)]
        trailing, leading = sliding.contact_ends(gap, shape, 1.0)
        assert trailing == pytest.approx(-5.3 - middle, abs=0.05)
        assert leading == pytest.approx(5.3 - middle, abs=0.05)
    assert np.isnan(sliding.contact_ends(x + 1.0, x, 1.0)).all()
    assert sliding.contact_ends(x - 100.0, x, 1.0) == (-32.5, 31.5)


def line(
    sliding_distance: list[float], force: list[float], after: tuple[int, ...] = (), width: float = 0.01
) -> polyline.Polyline:
    sliding_distance, force = np.array(sliding_distance, float), np.array(force, float)
    slipped = np.isin(np.arange(sliding_distance.size), after)
    wide = np.where(slipped | np.isin(np.arange(sliding_distance.size), np.array(after, int) - 1), width, 0.0)
    return polyline.Polyline(
        sliding_distance, force, np.full(sliding_distance.size, np.nan), slipped, wide, np.arange(sliding_distance.size)
    )


def test_the_onset_is_before_the_first_slip_or_at_the_first_maximum():
    force = [0.0, 1.0, 2.0, 1.9, 0.5, 3.0]
    assert line([0, 1, 2, 3, 3, 4], force, after=(4,)).onset == 2
    assert line([0, 1, 2, 3, 4, 5], force).onset == 2
    assert line([0, 1, 2, 3], [0, 1, 2, 3]).onset is None


def test_the_error_beside_a_slip_follows_from_its_width():
    slide = line([0, 1, 2, 2, 3], [0, 1, 2, 0.5, 1.5], after=(3,), width=0.01)
    assert slide.extreme_error(2) == pytest.approx(0.01)
    assert slide.extreme_error(3) == pytest.approx(0.01)
    bent = line([0, 1, 1.5, 1.5], [0, 1, 1.2, 0], after=(3,), width=0.0)
    assert bent.extreme_error(2) == pytest.approx(0.3)
    assert bent.slip_error(2) == 0.0
    assert line([0, 1, 2], [0, 1, 0]).extreme_error(1) == pytest.approx(0.25)


def sawtooth(direction: float) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """A spring of 1 N/m/nm that slips by 2 nm at 2.5 N/m and at 2.25 N/m, and keeps its contact."""
    states = {
        "sliding_distance": direction * np.arange(7.0),
        "friction_force": direction * np.array([0.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]),
        "elastic_energy": np.array([0.0, 1.0, 4.0, 1.0, 4.0, 1.0, 4.0]) / 2,
    }
    trailing, leading = sorted((0.0, direction * 8.0))
    states |= {"contact_trailing_edge": np.full(7, trailing), "contact_leading_edge": np.full(7, leading)}
    states |= {"line_load": np.full(7, 8.0), "contact_length": np.full(7, 8.0), "mean_gap": np.ones(7)}
    before, after = np.array([2.5, 2.25]), np.array([0.5, 0.25])
    events = {
        "event_step": np.array([3.0, 5.0]),
        "event_sliding_distance": direction * np.array([2.5, 4.25]),
        "event_width": np.full(2, 1e-6),
        "event_force_before": direction * before,
        "event_force_after": direction * after,
        "event_length_before": np.full(2, 8.0),
        "event_length_after": np.full(2, 8.0),
        "event_released_energy": (before**2 - after**2) / 2,
        "event_slip": np.full(2, 2.0),
    }
    return states, events


def test_the_numbers_of_a_sawtooth_are_those_by_hand():
    numbers, errors = friction.summarise_slide(*sawtooth(1.0), period=2.0)
    assert numbers["static_friction"] == 2.5
    assert numbers["mean_friction"] == (2.5 + 0.25) / 2  # from the onset on
    assert (numbers["slip_count"], numbers["first_slip_periods"], numbers["first_force_drop"]) == (2.0, 1.0, 2.0)
    assert numbers["first_slip_released_energy"] == 3.0
    assert numbers["sticking_stiffness"] == pytest.approx(1.0)
    assert numbers["stored_energy"] == 0.5
    assert errors["mean_friction"] <= 1e-5


def test_a_slide_backwards_has_the_numbers_of_its_mirror():
    forwards, backwards = (friction.summarise_slide(*sawtooth(sign), period=2.0) for sign in (1.0, -1.0))
    for numbers, mirrored in zip(forwards, backwards, strict=True):
        assert mirrored == pytest.approx(numbers, nan_ok=True)
    assert backwards[0]["static_friction"] == 2.5


def test_a_slip_on_the_way_back_drops_along_its_motion():
    states, events = sawtooth(1.0)
    states = {name: values[[0, 1, 2, 1]] for name, values in states.items()}  # turns at 2 nm
    states["friction_force"] = np.array([0.0, 1.0, 2.0, -0.5])
    events = {name: values[:1] for name, values in events.items()}
    events |= {"event_step": np.array([3.0]), "event_sliding_distance": np.array([1.5])}
    events |= {"event_force_before": np.array([-2.0]), "event_force_after": np.array([0.0])}
    assert friction.summarise_slide(states, events, period=2.0)[0]["first_force_drop"] == 2.0


def test_the_error_of_a_work_is_that_of_the_trapezoidal_rule():
    places = np.linspace(0.0, 4.0, 81)
    work, error = line(places, places**2).work()
    assert work - 4.0**3 / 3 == pytest.approx(error, rel=0.02)  # but for one of 80 steps


def test_the_quadratic_law_is_fitted_to_data_that_follow_it():
    force = np.linspace(0, 3, 40)
    coefficient, agreement = peeling.fit_quadratic_law(force, 100 - 2.5 * force**2)
    assert coefficient == pytest.approx(2.5)
    assert agreement == pytest.approx(1.0)
    assert np.isnan(peeling.fit_quadratic_law(force[:2], force[:2])).all()
    assert np.isnan(peeling.fit_quadratic_law(force, np.full(40, 5.0))).all()


def test_the_agreement_of_the_quadratic_law_is_that_by_hand():
    force, length = np.sqrt([0.0, 1.0, 2.0]), np.array([5.0, 4.0, 4.0])
    coefficient, agreement = peeling.fit_quadratic_law(force, length)
    assert coefficient == pytest.approx(0.6)  # (1·1 + 2·1)/(1² + 2²)
    assert agreement == pytest.approx(1 - 0.2 / (2 / 3))  # what is left of the squares about the mean


@pytest.mark.parametrize("exponent", [1.0, 2.0, 6.5])
def test_the_exponent_of_a_law_is_fitted(exponent):
    force = np.linspace(0, 3, 40)
    assert peeling.fit_exponent(force, 100 - 0.7 * force**exponent) == pytest.approx(exponent, rel=1e-4)
    assert np.isnan(peeling.fit_exponent(force, 100 - 0.7 * (force >= 3)))  # no exponent is large enough
    assert np.isnan(peeling.fit_exponent(force[:2], force[:2]))


def test_the_rate_ratio_compares_the_ends_of_the_squared_force():
    force = np.sqrt(np.linspace(0, 9, 101))
    assert peeling.peel_rate_ratio(force, 100 - 2 * force**2) == pytest.approx(1.0)
    bent = np.where(force**2 < 4.5, 2 * force**2, 9 + 6 * (force**2 - 4.5))
    assert peeling.peel_rate_ratio(force, 100 - bent) == pytest.approx(3.0)
    assert np.isnan(peeling.peel_rate_ratio(force, 100 + force**2))
    assert np.isnan(peeling.peel_rate_ratio(force[::30], 100 - bent[::30]))


def test_the_threshold_law_is_fitted_with_and_without_onsets_without_contact():
    length, force = np.array([1.0, 2, 3, 4, 0]), np.array([7.0, 9, 11, 13, 1])
    named = dict(zip(threshold.THRESHOLD, threshold.threshold_numbers(length, force)[:10], strict=True))
    assert named["shear_strength_contacts_only"] == pytest.approx(2.0)
    assert named["friction_without_contact_contacts_only"] == pytest.approx(5.0)
    assert named["threshold_r_squared_contacts_only"] == pytest.approx(1.0)
    assert named["threshold_residual_contacts_only"] < 1e-12
    slope, offset = np.polyfit(length, force, 1)
    assert (named["shear_strength"], named["friction_without_contact"]) == pytest.approx((slope, offset))
    residual = np.sqrt(np.mean((force - slope * length - offset) ** 2)) / 12
    assert named["threshold_residual"] == pytest.approx(residual)


def test_an_unknown_onset_leaves_the_threshold_law_unknown():
    length, force = np.array([1.0, 2, 3, 4]), np.array([7.0, 9, np.nan, 13])
    assert np.isnan(threshold.threshold_numbers(length, force)).all()
    assert np.isnan(threshold.threshold_numbers(np.ones(3), np.ones(3))).all()
    assert np.isnan(threshold.threshold_numbers(np.full(3, np.nan), np.arange(3.0))).all()


def test_curvature_is_a_square_term_in_its_errors():
    rng = np.random.default_rng(1)
    length = np.linspace(0, 5, 9)
    noise = [threshold.fit_threshold_law(length, 2 * length + rng.normal(size=9)) for _ in range(400)]
    spread = np.std([fit.threshold_curvature for fit in noise])
    assert spread == pytest.approx(np.sqrt(6 / 4), rel=0.2)  # of Student's t with six degrees of freedom
    bent = threshold.fit_threshold_law(length, 2 * length + 0.5 * length**2 + 0.1 * rng.normal(size=9))
    assert bent.threshold_curvature > 5


def test_curvature_and_its_error_are_those_of_another_code():
    rng, length = np.random.default_rng(3), np.linspace(0, 5, 6)
    force = 2 * length + 0.3 * length**2 + rng.normal(size=6)
    (square, _, _), covariance = np.polyfit(length, force, 2, cov=True)
    found = threshold.fit_threshold_law(length, force).threshold_curvature
    assert found == pytest.approx(square / np.sqrt(covariance[0, 0]), rel=1e-9)


def test_leaving_out_approaches_measures_the_scatter_of_a_slope():
    rng = np.random.default_rng(2)
    length = np.linspace(0, 5, 9)
    fits = [threshold.threshold_numbers(length, 2 * length + rng.normal(size=9)) for _ in range(300)]
    slopes, errors = np.array(fits)[:, 0], np.array(fits)[:, 10]
    assert np.sqrt(np.mean(errors**2)) == pytest.approx(slopes.std(), rel=0.25)


def test_peeling_at_one_edge_is_asymmetric():
    trailing, leading = np.array([-5.0, -4.0, -2.0, np.nan]), np.array([5.0, 4.0, 4.0, np.nan])
    distance = np.arange(4.0)
    assert peeling.edge_peel(trailing, leading, distance, 1.0) == (1.0, 1.0)
    assert peeling.edge_peel(trailing, leading, distance, 1.5) == (2.0, 1.0)
    assert np.isnan(peeling.edge_peel(trailing, leading, distance, 3.0)).all()
    assert peeling.peel_asymmetry(1.0, 1.0) == 0.0
    assert peeling.peel_asymmetry(3.0, 1.0) == pytest.approx(0.5)
    assert peeling.peel_asymmetry(3.0, -1.0) == pytest.approx(2.0)
    assert np.isnan(peeling.peel_asymmetry(0.0, 0.0))
    assert np.isnan(peeling.peel_asymmetry(1.0, -2.0))


def test_the_shift_is_read_where_a_share_of_the_loss_is_lost():
    trailing, leading = np.array([-5.0, -4.0, -1.0, 1.0]), np.array([5.0, 4.0, 4.0, 3.0])
    assert peeling.edge_shift(trailing, leading, 0.25) == pytest.approx(0.0)
    assert peeling.edge_shift(trailing, leading, 0.5) == pytest.approx(1.0)
    assert peeling.edge_shift(trailing, leading, 1.0) == pytest.approx(2.0)
    lost = np.array([False, False, False, True])
    without = [np.where(lost, np.nan, edge) for edge in (trailing, leading)]
    assert peeling.edge_shift(*without, 0.25) == pytest.approx(0.25)
    assert peeling.edge_shift(*without, 0.75) == pytest.approx(1.5)
    assert np.isnan(peeling.edge_shift(*[edge[:1] for edge in without], 0.25))
    assert np.isnan(peeling.edge_shift(trailing[::-1], leading[::-1], 0.25))


def test_slips_that_reattach_are_counted_one_by_one():
    data = dataset()
    assert float(friction.summarise_slides(data).reattachment_count) == float(
        friction.summarise_slides(data).slip_count
    )
    after = data.event_length_after.copy()
    after[{"event": 1}] = 0.0
    summary = friction.summarise_slides(data.assign(event_length_after=after))
    assert float(summary.reattachment_count) == float(summary.slip_count) - 1
    assert float(friction.summarise_slides(dataset_without_slips()).reattachment_count) == 0


def test_flats_that_stick_are_springs_in_series():
    data = friction.summarise_slides(simulate(flat(70.0, 0.2, [0.0, 8.0]), points=16, tolerance=1e-7))
    stiffness = 70.0 / (2 * (1 + RATIO)) / 500.0
    slope = springs.sticking_stiffness(stiffness, 0.2, LATTICE)
    distance = np.linspace(0.0, 1e-3, 5)
    np.testing.assert_allclose(exact(70.0, 0.2, distance), slope * distance, rtol=1e-6, atol=1e-9)
    assert float(data.sticking_stiffness) / 100.0 == pytest.approx(slope, rel=0.1)
    assert float(data.sticking_r_squared) > 0.98
    assert slope < stiffness


def test_a_sine_slides_by_the_model_of_prandtl_and_tomlinson():
    offsets = np.linspace(0.0, LATTICE, 401)
    sine = springs.sine_sum(offsets, LATTICE)
    assert sine.max() == pytest.approx(springs.spring_sum(offsets, LATTICE)[1].max(), rel=1e-4)
    np.testing.assert_allclose(sine[::-1], -sine, atol=1e-12)
    steepest = 2 * np.pi / LATTICE * sine.max()  # of a sine; stick-slip ends where the body is as stiff
    slides = np.linspace(0.0, 12.0, 12001)
    for beside, slips in ((0.9, True), (1.1, False)):
        force = springs.uniform_slide(slides, beside * 0.1 * steepest, 0.1, LATTICE, sine=True)
        gap = slides - force / (beside * 0.1 * steepest)
        np.testing.assert_allclose(force, 0.1 * springs.sine_sum(gap, LATTICE), atol=1e-9)
        assert (np.diff(gap).max() > 0.1 * LATTICE) == slips


def test_friction_over_strength_depends_on_modulus_over_strength_alone():
    slides = np.linspace(0.0, 12.0, 601)
    np.testing.assert_allclose(exact(140.0, 0.2, slides), 2 * exact(70.0, 0.1, slides), rtol=1e-12)
    forces = [walked(flat(modulus, work, [0.0, 6.0], 0.2, 8))[3] for modulus, work in ((140.0, 0.2), (70.0, 0.1))]
    np.testing.assert_allclose(forces[0], 2 * forces[1], atol=1e-5 * forces[0].max())


def test_the_shift_is_half_the_difference_of_what_peels_over_the_contact():
    data = friction.summarise_slides(dataset())
    for suffix in ("", "_halfway"):
        behind, ahead = (float(data[f"{edge}_peel{suffix}"]) for edge in ("trailing", "leading"))
        shift = (behind - ahead) / 2 / float(data.initial_contact_length)
        assert float(data[f"contact_shift{suffix}"]) == pytest.approx(shift)
        assert behind + ahead > 0
    before = np.flatnonzero(data.jump.values > 0)[0] - 1
    centres = (data.contact_trailing_edge + data.contact_leading_edge).values / 2
    shift = (centres[before] - centres[20]) / float(data.initial_contact_length)
    assert float(data.contact_shift) == pytest.approx(shift)


def test_a_contact_that_is_lost_has_no_reattached_share():
    data = dataset()
    found = friction.summarise_slides(data.assign(event_length_after=0 * data.event_length_after))
    assert np.isnan(found.reattached_fraction)
    assert found.regained_fraction < 0


def test_stored_and_released_energy_are_those_of_one_degree_of_freedom():
    for modulus in (70.0, 140.0):
        found = friction.summarise_slides(simulate(flat(modulus, 0.2, [0.0, 8.0]), points=16, tolerance=1e-7))
        stiffness = modulus / (2 * (1 + RATIO)) / 500.0
        area = 100.0  # of the period
        force = exact(modulus, 0.2, np.array([1.0, float(found.event_sliding_distance[0]) - 1e-3]))
        assert float(found.stored_energy) == pytest.approx(area * force[0] ** 2 / 2 / stiffness, rel=2e-3)
        before, after = (float(found[f"event_force_{side}"][0]) / area for side in ("before", "after"))
        released = area * (before**2 - after**2) / 2 / stiffness
        assert float(found.first_slip_released_energy) == pytest.approx(released, rel=1e-3)
        assert float(found.released_share) == pytest.approx(1 - (after / before) ** 2, rel=2e-3)
        assert before == pytest.approx(force[1], rel=5e-3)
    assert np.isnan(friction.summarise_slides(simulate(flat(70.0, 0.2, [0.0, 0.8]), points=16)).stored_energy)


def test_a_force_is_averaged_over_whole_lattice_constants():
    sliding_distance = np.linspace(0, 10, 1001)
    wave = line(sliding_distance, 2 + np.sin(2 * np.pi * sliding_distance / 3.0))
    mean, error = polyline.average_force(wave, 3.0)
    assert mean == pytest.approx(2.0, abs=1e-4)
    assert abs(mean - 2.0) <= error < 1e-3
    assert np.isnan(polyline.average_force(wave, 11.0)).all()
    assert np.isnan(polyline.average_force(line([0, 1, 0], [0, 1, 0]), 0.1)).all()
    sawtooth = line([0, 2, 2, 4, 4, 6], [0, 2, 0, 2, 0, 2], after=(2, 4), width=0.0)
    assert polyline.average_force(sawtooth, 2.0)[0] == pytest.approx(1.0)


def test_a_slide_without_an_onset_has_no_static_friction():
    data = friction.summarise_slides(dataset_without_slips())
    assert float(data.slip_count) == 0
    assert np.isnan(data.event_sliding_distance).all()
    assert float(data.initial_contact_length) > 0
    for name in (
        "static_friction",
        "onset_sliding_distance",
        "first_force_drop",
        "mean_friction",
        "peeled_fraction",
        "quadratic_r_squared",
    ):
        assert np.isnan(data[name]), name


@pytest.mark.parametrize("increment", [0.1, 0.02])
@pytest.mark.parametrize("increments", ["requested", "adaptive"])
@pytest.mark.parametrize(("modulus", "slips"), [(480.0, True), (526.0, False), (560.0, False)])  # critical: 517.7
def test_a_fast_smooth_slide_is_no_slip(modulus, slips, increments, increment):
    scene, how = flat(modulus, 0.2, [0.0, 5.0], increment), INCREMENTS[increments]()
    data = simulate(scene, solver="newton", points=16, tolerance=1e-7, increments=how)
    assert (float(friction.summarise_slides(data).slip_count) > 0) == slips


@pytest.mark.parametrize("increment", [0.1, 0.7, 11.0])
def test_slips_are_found_one_by_one_whatever_the_increment(increment):
    scene = flat(70.0, 0.2, [0.0, 11.0], increment)
    found = friction.summarise_slides(simulate(scene, solver="newton", points=16, tolerance=1e-7))
    slides = np.linspace(0.0, 11.0, 110001)
    drops = np.flatnonzero(np.diff(exact(70.0, 0.2, slides)) < -0.01)
    np.testing.assert_array_less(np.abs(found.event_sliding_distance - slides[drops + 1]), found.event_width + 2e-4)
    np.testing.assert_allclose(found.event_force_before / 100, exact(70.0, 0.2, slides)[drops], rtol=6e-3)
    np.testing.assert_allclose(found.event_force_after / 100, exact(70.0, 0.2, slides)[drops + 1], rtol=6e-3)
    assert np.isnan(found.event_length_after).all()


def test_a_solver_without_predictions_sees_slips_in_increments_of_half_a_nanometre():
    scene = probe(path_of(0.0, [0.0, 11.0], 0.5))
    data = simulate(scene, solver="mass_weighted_verlet", points=64, tolerance=1e-6)
    assert float(friction.summarise_slides(data).slip_count) == 2


def test_a_frictionless_slide_has_no_force():
    scene = probe(path_of(0.0, [0.0, 3.0], 0.5), CohesiveZone(2.0))
    data = friction.summarise_slides(simulate(scene, solver="newton", points=128, tolerance=1e-7))
    assert (data.friction_force == 0).all()
    assert np.isnan(data.static_friction)
    assert not [name for name in data if str(name).startswith("tangential_traction")]


@cache
def dataset_without_slips() -> xr.Dataset:
    scene = probe(path_of(0.0, [0.0, 1.0], 0.1))
    return simulate(scene, solver="newton", points=128, tolerance=1e-7)


@pytest.mark.parametrize("turn", [9.42, 8.44, 10.9])
@pytest.mark.parametrize("increments", ["requested", "adaptive"])
def test_a_large_step_back_does_not_land_a_cell_further_on(turn, increments):
    """States a cell apart are alike, so the last one, carried along, is near a wrong one."""
    back = turn - LATTICE
    small, large = (path_of(0.0, [0.0, turn, back], increment) for increment in (0.05, 20.0))
    forces = [
        walked(probe(path), 128, increments=how)[3][-1]
        for path, how in ((small, None), (large, INCREMENTS[increments]()))
    ]
    assert forces[1] == pytest.approx(forces[0], rel=2e-3)


def test_the_cost_of_a_slide_includes_all_its_slips():
    found = summarise_solutions(combine_runs([(dataset(), {"member": 0})]))
    assert found.transforms.item() == dataset().transforms.sum().item()
    assert found.static_friction.item() == friction.summarise_slides(dataset()).static_friction.item()
    assert "event" not in found.dims
