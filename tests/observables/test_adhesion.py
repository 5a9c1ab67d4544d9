"""What a path of smooth laws amounts to, and the limits of an adhesive cylinder."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from contactsim.contact.loading import approaches
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.observables.adhesion import (
    contact_length,
    find_peaks,
    gradients,
    histograms,
    slips,
    state_observables,
    touching_peaks,
)
from contactsim.observables.load_curve import LoadCurve, join_folds
from contactsim.observables.path_summary import FINAL, SUMMARY, largest_jumps, legs, pull_off, summarise_load_curves
from contactsim.reference import adhesion, hard_wall
from contactsim.simulation import simulate
from contactsim.study.law_table import tabulate_law
from contactsim.surfaces.shapes import Cylinder
from contactsim.surfaces.statistics import local_squares, rms_gradient
from support.smooth import LAWS, LENGTH, along, scene_of, walk

APPROACH = np.array([-3.0, -2.0, -1.0, 0.0, -1.0, -2.0, -3.0])
LOAD = np.array([-0.1, -5.0, -4.5, 2.0, -4.5, -6.0, -0.1])


def curve(approach: np.ndarray, load: np.ndarray) -> LoadCurve:
    """The curve of a path without a jump."""
    return LoadCurve.from_states(approach, load, np.zeros(load.size))


def test_pull_off_is_found_on_each_leg_with_what_the_increments_leave_open():
    found = pull_off(curve(APPROACH, LOAD))
    assert (found["pull_off_load_loading"], found["pull_off_approach_loading"]) == (5.0, -2.0)
    assert (found["pull_off_load_unloading"], found["pull_off_approach_unloading"]) == (6.0, -2.0)
    assert found["pull_off_load_loading_increment_error"] == pytest.approx(1.35)  # a quarter of 0.5 + 4.9
    assert found["pull_off_load_unloading_increment_error"] == pytest.approx(1.85)
    assert found["pull_off_approach_loading_increment_error"] == 1.0


def test_a_contact_ends_where_the_gap_between_two_nodes_is_zero():
    x = np.arange(64.0)
    for middle, half in ((31.3, 10.2), (2.0, 5.75), (0.0, 0.4)):  # two lie across the seam
        distance = np.abs((x - middle + 32) % 64 - 32)
        assert contact_length(0.7 * (distance - half), 3.0) == pytest.approx(6.0 * half, rel=1e-12)


def test_a_path_that_only_loads_has_no_unloading():
    found = pull_off(curve(APPROACH[:4], LOAD[:4])) | largest_jumps(APPROACH[:4], np.zeros(4))
    assert all(np.isnan(found[name]) for name in found if "unloading" in name)
    assert found["max_jump_loading"] == 0.0
    assert legs(APPROACH) == (slice(0, 4), slice(4, 7))


@pytest.mark.parametrize(
    ("approach", "load", "loading", "unloading"),
    [
        ([0, 1, 2, 1, 0, -1], [0, -3, 5, 1, -2, -4], 3.0, np.nan),  # not yet open
        ([0, 1, 2, 1, 0, -1], [0, -3, 5, 1, -4, np.nan], 3.0, 4.0),  # pulled apart by a load
        ([0, 1, 2], [-4, -3, 5], np.nan, np.nan),  # pulls most where it begins
        ([0, 1, 2, 1, 0, 1, 0, -1, -2], [0, -3, 5, 1, -2, -2.5, -3, -9, 0], 3.0, np.nan),  # a second cycle is another
        ([0, 1, 2, 1, 0, 1, 2, 3], [0, -3, 5, -6, 1, -9, 5, 6], 3.0, 6.0),  # and goes deeper
        ([5, 4, 6, 7], [50, 20, 80, 90], np.nan, np.nan),  # never pulls
    ],
)
def test_a_leg_that_does_not_pass_its_largest_pull_has_no_pull_off(approach, load, loading, unloading):
    found = pull_off(curve(np.array(approach, float), np.array(load, float)))
    both = [found[f"pull_off_load_{name}"] for name in ("loading", "unloading")]
    assert np.array_equal(both, [loading, unloading], equal_nan=True)
    missing = [
        np.isnan(found[f"pull_off_{what}_loading{end}"])
        for what in ("load", "approach")
        for end in ("", "_increment_error")
    ]
    assert missing == [np.isnan(loading)] * 4


def test_states_that_did_not_converge_are_no_pull_off_and_no_last_state():
    numbers = {name: ("step", np.arange(7.0)) for name in {*FINAL.values(), "jump"}}
    data = xr.Dataset(numbers | {"approach": ("step", APPROACH), "line_load": ("step", LOAD)})
    data["status"] = ("step", np.array([0, 1, 0, 1, 0, 0, 0], np.int8))
    found = summarise_load_curves(data.merge(join_folds([])))
    assert set(SUMMARY) <= set(found)
    assert float(found.pull_off_load_loading) == 4.5
    assert (float(found.max_jump_loading), float(found.max_jump_unloading)) == (2.0, 6.0)
    assert np.isnan(found.final_load)


def test_the_pull_off_of_jkr_is_the_least_load_of_its_crack():
    work, radius, modulus = 2.0, 25000.0, 77.0

    def load(half_width):
        opened = np.sqrt(2 * np.pi * modulus * work * half_width)
        return hard_wall.cylinder_load(half_width, radius, modulus) - opened

    least = minimize_scalar(load, bounds=(1.0, 2000.0), method="bounded", options={"xatol": 1e-9})
    assert adhesion.cylinder_pull_off(work, radius, modulus) == pytest.approx(-least.fun, rel=1e-10)
    assert least.x**3 == pytest.approx(2 * work * radius**2 / (np.pi * modulus), rel=1e-4)


def test_the_crack_of_jkr_releases_its_work():
    half_width, modulus, work = 200.0, 77.0, 2.0
    force = np.sqrt(2 * np.pi * modulus * work * half_width)  # of a flat punch; its edge has K = P/√(π c)
    assert force**2 / (np.pi * half_width) / (2 * modulus) == pytest.approx(work)  # G = K²/(2E*): one body gives way


def test_the_pull_off_of_a_rigid_cylinder_is_the_largest_of_its_integrals():
    work, radius, length = 2.0, 500.0, 1.3
    law = NormalCohesiveZone(work, length)

    def pull(gap):
        return quad(lambda x: law.traction(np.array([[gap + x**2 / (2 * radius)]]))[0, 0], -400, 400, limit=200)[0]

    best = minimize_scalar(lambda gap: -pull(gap), bounds=(0.0, 3.0), method="bounded")
    assert adhesion.rigid_cylinder_pull_off(work, radius, length) == pytest.approx(-best.fun, rel=1e-6)
    assert best.x == pytest.approx(length / 2, abs=1e-3)


def test_the_load_of_a_contact_is_its_repulsive_part_less_its_adhesive_part():
    result = walk(scene_of(LAWS["frictional"], approaches([-1.0, 0.0], 0.5)), 64)
    numbers = state_observables(result.problem, *result.states[-1].fields())
    assert min(numbers["repulsive_load"], numbers["adhesive_load"]) > 0
    assert numbers["repulsive_load"] - numbers["adhesive_load"] == pytest.approx(numbers["line_load"])


def test_a_tabulated_law_peaks_at_its_strengths():
    settings = {"effect": "cohesive_zone", "work_of_separation": 2.0, "work_ratio": 0.5, "normal_length": 1.5}
    settings |= {"tangential_length": 0.8, "normal_gap": [-0.5, 0.0, 1.0], "tangential_gap": [0.0, 0.4], "reach": 6.0}
    data = tabulate_law(settings)
    normal = adhesion.normal_strength(2.0, 1.5, data.tangential_gap.values / 0.8)
    assert np.allclose(data.normal_traction.max("opening"), normal, rtol=1e-4)
    tangential = adhesion.tangential_strength(1.0, 0.8, data.normal_gap.values / 1.5)
    assert np.allclose(data.tangential_traction.max("slip_gap"), tangential, rtol=1e-3)
    assert np.allclose(data.tangential_traction, -data.tangential_traction[:, ::-1])
    assert abs(normal[0] - CohesiveZone(2.0, 0.5, 1.5, 0.8).strength) < 1e-15


def test_local_squares_give_the_gradient_over_any_part():
    heights = np.random.default_rng(3).normal(size=50)
    where = heights > 0.3
    square = local_squares(heights, 0.7)
    assert np.sqrt(square.mean()) == pytest.approx(rms_gradient(heights, 0.7), rel=1e-12)
    assert np.sqrt(square[where].mean()) == pytest.approx(rms_gradient(heights, 0.7, where), rel=1e-12)


def test_gradients_follow_both_criteria_and_are_none_without_contact():
    problem = pose_cohesive(scene_of(LAWS["uncoupled"]), np.zeros(8), 1e-7)
    square = np.arange(8.0) ** 2
    gap = np.array([[-0.5, -0.1, 0.2, 1.0, 30.0, 30.0, 30.0, 30.0]])
    found = gradients(square, problem, gap, problem.traction(gap))
    assert found["rms_gradient_repulsive"] == pytest.approx(np.sqrt(0.5))
    assert found["rms_gradient_interacting"] == pytest.approx(np.sqrt(3.5))  # four points
    assert found["rms_gradient"] == pytest.approx(np.sqrt(17.5))
    apart = np.full((1, 8), 40.0)
    assert np.isnan(gradients(square, problem, apart, problem.traction(apart))["rms_gradient_repulsive"])


def test_histograms_hold_every_point_and_their_ends_what_lies_beyond():
    problem = pose_cohesive(scene_of(LAWS["uncoupled"]), np.zeros(4), 1e-7)
    gap = np.array([[-100.0, 0.1, 0.1, 100.0]])
    shares = histograms(problem, gap, problem.traction(gap))
    assert shares["normal_gap_share"][[0, 12, -1]].tolist() == [0.25, 0.5, 0.25]
    assert shares["normal_gap_share"].sum() == shares["normal_traction_share"].sum() == 1.0
    assert shares["normal_traction_share"][0] == 0.25  # the strongest push


def test_slip_counts_where_there_is_traction_and_by_how_much():
    slip, size = np.array([9.0, 0.1, 0.4, 0.2]), np.array([0.001, 0.1, 0.3, 0.1])
    found = slips(slip, size)
    assert found["rms_slip"] == pytest.approx(np.sqrt((0.1 * 0.1**2 + 0.3 * 0.4**2 + 0.1 * 0.2**2) / 0.5))
    assert found["slipped_share"] == pytest.approx(1 / 3)
    assert slips(slip, 0 * size) == {"rms_slip": 0.0, "slipped_share": 0.0}


def test_a_peak_is_where_surfaces_would_meet_first_and_counts_in_contact():
    peaks = find_peaks(np.array([1.0, 3.0, 2.0, 4.0, 0.0, 5.0]))
    assert np.flatnonzero(peaks).tolist() == [0, 2, 4]
    assert touching_peaks(peaks, np.ones(6)) == 3.0
    assert touching_peaks(peaks, np.array([1.0, 1.0, 0.0, 1.0, 1.0, 1.0])) == 2.0


def test_a_path_ends_at_complete_contact_if_it_is_asked_to():
    blunt = Cylinder(length=LENGTH, radius=2.5e6)  # 5 nm from its highest to its lowest point
    scene = scene_of(LAWS["uncoupled"], along(0.0, 20.0, 2.5), surface=blunt)
    whole, ended = (simulate(scene, points=64, tolerance=1e-6, until=end) for end in (None, "complete_contact"))
    complete = whole.contact_length >= whole.length
    assert complete[-1] and complete.sum() > 1
    assert ended.sizes["step"] == int(complete.argmax("step")) + 1
    assert ended.line_load.values == pytest.approx(whole.line_load.values[: ended.sizes["step"]])


def test_fields_of_some_members_alone_are_kept_and_histograms_of_all():
    scene = scene_of(LAWS["uncoupled"], along(-1.0, 0.0, 0.5))
    kept, left = (
        simulate(scene, points=64, tolerance=1e-6, snapshots=[0.0], keep_fields=keep) for keep in (True, False)
    )
    assert {"normal_gap", "heights", "x"} <= {*kept.variables}
    assert not {"normal_gap", "heights", "x"} & {*left.variables}
    assert left.normal_gap_share.dims == ("snapshot", "normal_gap_bin")
    assert np.allclose(left.normal_gap_share.sum("normal_gap_bin"), 1.0)
    assert left.mean_pressure[-1] == pytest.approx(float(left.line_load[-1]) / LENGTH)


def test_the_pull_off_of_maugis_lies_between_a_crack_and_rigid_bodies():
    work, radius, modulus = np.array([0.5, 2.0]), 1000.0, 70.0
    crack = adhesion.maugis_cylinder_pull_off(work, radius, modulus, 1e3)
    assert crack == pytest.approx(adhesion.cylinder_pull_off(work, radius, modulus), rel=2e-3)
    strength = 0.01
    rigid = adhesion.maugis_cylinder_pull_off(work, 10.0, 1e6, strength)
    assert rigid == pytest.approx(2 * strength * np.sqrt(2 * 10.0 * work / strength), rel=2e-3)
    between = adhesion.maugis_cylinder_pull_off(work, radius, modulus, 1.0)
    assert (between < adhesion.cylinder_pull_off(work, radius, modulus)).all()
    assert (between < 2 * np.sqrt(2 * radius * work)).all()


@pytest.mark.parametrize("strength", [1e-4, 1e-3, 1e-2])
def test_the_weakest_contacts_of_maugis_pull_off_as_a_strip_under_uniform_traction(strength):
    work, radius, modulus = 1.0, 1e4, 1.0
    bulge = 4 * strength * np.log(2) / (np.pi * modulus)  # middle over edge of a strip, per half-width (Johnson 1985)
    half_width = radius * (np.sqrt(bulge**2 + 2 * work / (strength * radius)) - bulge)  # a²/2R + bulge a = w/σ
    pull_off = adhesion.maugis_cylinder_pull_off(work, radius, modulus, strength)
    assert pull_off == pytest.approx(2 * strength * half_width, rel=1e-8)
