"""Springs between a surface and a lattice: sums as Eqs 6.2-6.4 write them, balanced, periodic; what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from contactsim.contact.loading import LoadPath, approaches, pressures, sweep
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep, Slide
from contactsim.elasticity.layer import Layer
from contactsim.errors import InputError
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.frictional_repulsion import FrictionalRepulsiveZone
from contactsim.interface.hard_wall import HardWall
from contactsim.interface.lattice import Lattice
from contactsim.interface.pairing import ALIGNED
from contactsim.interface.superposition import superpose
from contactsim.reference.springs import spring_sum, steepest_fall
from contactsim.simulation import simulate
from contactsim.surfaces.shapes import Cylinder, Flat
from contactsim.traits import Trait

LAW = CohesiveZone(2.0, 0.7, 1.0, 0.8)
BODY = Layer(70.0, 0.45, 500.0)
HELD = LoadStep(Trait.APPROACH, 0.0)


def gaps(points: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.stack((rng.uniform(-0.5, 6.0, points), rng.uniform(-40.0, 40.0, points)))


def literal(gap: np.ndarray, lower: np.ndarray, lattice: float, law: CohesiveZone) -> tuple[np.ndarray, np.ndarray]:
    """Every spring between every two nodes of a period and its images: on the upper and on the lower nodes."""
    points = gap.shape[1]
    upper, below = np.zeros((2, points)), np.zeros((2, points))
    for i in range(points):
        for j in range(-3 * points, 4 * points):
            along = gap[1, i] - (j - i) * lattice
            if abs(along) < 8 * law.tangential_length:
                each = np.array([[gap[0, i] + lower[i] - lower[j % points]], [along]])
                pull = law.traction(each)[:, 0]
                upper[:, i] += pull
                below[:, j % points] -= pull
    return upper, below


@pytest.mark.parametrize("rough", [False, True])
def test_springs_are_the_literal_sum_over_all_pairs_of_nodes(rough):
    points, lattice = 24, 1.7
    lower = 0.3 * np.sin(2 * np.pi * np.arange(points) / points) * rough
    gap = gaps(points)
    springs = Lattice(lattice, tangential_cutoff=8.0).join(LAW, lower, points * lattice)
    upper, below = literal(gap, lower, lattice, LAW)
    np.testing.assert_allclose(springs.traction(gap), upper, rtol=0, atol=1e-13 * np.abs(upper).max())
    np.testing.assert_allclose(springs.lower_traction(gap), below, rtol=0, atol=1e-12 * np.abs(upper).max())


def test_a_wave_below_is_met_at_the_sites_also_between_points_of_the_mesh():
    points, lattice, length = 32, 1.234, 54.4
    x, gap = np.arange(points) * length / points, gaps(points)

    def lower(place: np.ndarray) -> np.ndarray:
        return 0.3 * np.sin(2 * np.pi * place / length) + 0.1 * np.cos(6 * np.pi * place / length)

    springs = Lattice(lattice, tangential_cutoff=8.0).join(LAW, lower(x), length)
    sites = np.rint(gap[1] / lattice) + np.arange(-6.0, 7.0)[:, None]
    each = np.stack((gap[0] + lower(x) - lower(x + sites * lattice), gap[1] - sites * lattice))
    expected = LAW.traction(each.reshape(2, -1)).reshape(2, *sites.shape).sum(1)
    np.testing.assert_allclose(springs.traction(gap), expected, rtol=0, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("cutoff", [0.0, 0.4, 1.0, 2.0, 5.0])
def test_no_site_within_the_cutoff_is_left_out(cutoff):
    lattice = 1.5
    sites = Lattice(lattice, tangential_cutoff=cutoff).join(LAW, np.zeros(4), 6.0).offsets
    assert np.array_equal(sites, np.arange(-sites.max(), sites.max() + 1))
    nearest_without = lattice * (sites.max() + 0.5)  # of a surface half a cell beside its nearest site
    assert nearest_without >= cutoff * LAW.tangential_length


@pytest.mark.parametrize("lattice", [1.7, 1.234])
@pytest.mark.parametrize("rough", [False, True])
def test_action_equals_reaction(lattice, rough):
    points = 64
    lower = 0.2 * np.cos(2 * np.pi * np.arange(points) / points) * rough
    springs = Lattice(lattice).join(LAW, lower, points * 1.7)
    gap = gaps(points)
    total = springs.traction(gap).sum(1)
    np.testing.assert_allclose(
        springs.lower_traction(gap).sum(1), -total, atol=3e-14 * np.abs(springs.traction(gap)).sum()
    )


def test_the_tangent_is_the_derivative_of_the_traction():
    points = 32
    springs = Lattice(2.0).join(LAW, 0.2 * np.sin(np.arange(points) * 2 * np.pi / points), 100.0)
    gap = gaps(points, 1)
    gap[1] += 0.3  # away from where the nearest site changes
    traction, tangent = springs.tangent(gap)
    np.testing.assert_array_equal(traction, springs.traction(gap))
    for column in range(2):
        change = np.zeros_like(gap)
        change[column] = 1e-6
        slope = (springs.traction(gap + change) - springs.traction(gap - change)) / 2e-6
        np.testing.assert_allclose(tangent[:, column], slope, atol=1e-8 * springs.stiffness)


def test_a_flat_lattice_sums_to_the_exact_series():
    lattice, gap = 1.95, np.stack((np.linspace(-1.0, 4.0, 50), np.linspace(-7.0, 7.0, 50)))
    springs = Lattice(lattice, tangential_cutoff=10.0).join(LAW, np.zeros(50), 100.0)
    cosines, sines = spring_sum(gap[1], lattice, LAW.tangential_length)
    opening = gap[0] / LAW.normal_length
    normal = LAW.work_of_separation / LAW.normal_length * opening * np.exp(-opening) * cosines
    tangential = LAW.tangential_work / LAW.tangential_length * np.exp(-opening) * sines
    np.testing.assert_allclose(springs.traction(gap), [normal, tangential], atol=1e-13)


@pytest.mark.parametrize(
    ("ratio", "largest", "fall"),
    [
        (1, 1.2e-3, 0.007),
        (1.22, 0.02, 0.10),
        (1.5, 0.12, 0.52),
        (2, 0.47, 1.48),
        (2.44, 0.71, 1.79),
        (4.88, 0.858, 0.89),
    ],
)
def test_sums_of_springs_have_their_known_strength_and_fall(ratio, largest, fall):
    sums = spring_sum(np.linspace(0, ratio, 2001), ratio)[1]
    assert sums.max() == pytest.approx(largest, rel=0.06)
    assert steepest_fall(ratio) == pytest.approx(fall, rel=0.06)


def test_a_slide_by_whole_lattice_constants_changes_nothing():
    pairing, gap = Lattice(2.44), gaps(16)
    springs = pairing.join(LAW, np.zeros(16), 100.0)
    further = gap + [[0.0], [7 * 2.44]]
    np.testing.assert_allclose(springs.traction(further), springs.traction(gap), atol=1e-12)
    np.testing.assert_allclose(pairing.offset(further), pairing.offset(gap), atol=1e-12)


def test_a_rough_lattice_repeats_itself_after_a_period():
    lower, lattice = 0.3 * np.sin(2 * np.pi * np.arange(20) / 20), 2.0
    springs = Lattice(lattice).join(LAW, lower, 20 * lattice)
    gap = gaps(20)
    again = springs.traction(gap + [[0.0], [20 * lattice]])
    np.testing.assert_allclose(again, springs.traction(gap), atol=1e-12)


def test_a_cutoff_of_zero_joins_aligned_points():
    gap = np.stack((np.linspace(-1, 4, 30), np.linspace(-0.9, 0.9, 30)))
    own = Lattice(2.0, tangential_cutoff=0.0).join(LAW, np.zeros(30), 60.0)
    np.testing.assert_array_equal(own.traction(gap), ALIGNED.join(LAW, np.zeros(30), 60.0).traction(gap))
    for one, other in zip(own.tangent(gap), LAW.tangent(gap), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    "law",
    [
        LAW,
        CohesiveZone(2.0),
        UncoupledCohesiveZone(2.0, 0.5),
        FrictionalRepulsiveZone(2.0, 0.5),
        superpose((LAW, CohesiveZone(1.0))),
    ],
)
def test_any_law_that_reads_the_tangential_gap_can_be_a_spring(law):
    springs = Lattice(1.5, tangential_cutoff=3.0).join(law, np.zeros(10), 15.0)
    gap = gaps(10)
    sites = 1.5 * (np.rint(gap[1:] / 1.5) + springs.offsets[:, None, None])
    each = [law.traction(np.concatenate((gap[:1], gap[1:] - site))) for site in sites]
    np.testing.assert_allclose(springs.traction(gap), sum(each), atol=1e-13)
    assert springs.reads == law.reads
    assert springs.exerts == law.exerts
    assert springs.strength >= law.strength


class Bowl(CohesiveZone):
    """A law with the potential Δn² + 3 Δt²."""

    traits = frozenset({Trait.SMOOTH})

    def energy(self, gap: np.ndarray) -> np.ndarray:
        return gap[0] ** 2 + 3 * gap[1] ** 2


def test_potentials_add():
    springs = Lattice(1.5, tangential_cutoff=2.0, weight=0.5).join(Bowl(1.5), np.zeros(10), 15.0)
    gap = np.stack((np.full(10, 2.0), np.zeros(10)))
    np.testing.assert_allclose(springs.energy(gap), 0.5 * sum(4.0 + 3 * (1.5 * site) ** 2 for site in springs.offsets))


def test_weights_count_and_deep_gaps_do_not():
    gap = np.array([[1.0, 9.0, 11.0], [0.2, 0.2, 0.2]])
    whole, half = (Lattice(2.0, weight=weight).join(LAW, np.zeros(3), 6.0) for weight in (1.0, 0.5))
    np.testing.assert_allclose(half.traction(gap), 0.5 * whole.traction(gap))
    cut = Lattice(2.0, normal_cutoff=10.0).join(LAW, np.zeros(3), 6.0).traction(gap)
    np.testing.assert_array_equal(cut[:, :2], whole.traction(gap)[:, :2])
    assert not cut[:, 2].any()


def test_springs_are_paid_for_in_range_only(monkeypatch):
    asked = []
    springs = Lattice(2.0, tangential_cutoff=5.0).join(LAW, np.zeros(1000), 2000.0)
    count = len(springs.offsets)
    traction = CohesiveZone.traction
    monkeypatch.setattr(CohesiveZone, "traction", lambda law, gap: asked.append(gap.shape[1]) or traction(law, gap))
    gap = np.stack((np.linspace(0.0, 400.0, 1000), np.zeros(1000)))
    springs.traction(gap)
    assert asked == [count * np.count_nonzero(gap[0] <= 40.0)]


def test_strength_and_stiffness_bound_what_springs_do():
    gap = np.stack([each.ravel() for each in np.meshgrid(np.linspace(0, 3, 61), np.linspace(-2, 2, 81))])
    for lattice in (0.2, 1.0, 2.44, 5.0):
        springs = Lattice(lattice).join(LAW, np.zeros(8), 100.0)
        traction, tangent = springs.tangent(gap)
        assert traction[0].max() <= springs.strength * (1 + 1e-12)
        assert traction[0].max() == pytest.approx(springs.strength, rel=1e-3)
        assert np.abs(tangent).max() <= 1.01 * springs.stiffness


def sliding(lower: object = None, upper: object = BODY, law: object = LAW, pairing: object = ALIGNED) -> Scene:
    surface = Cylinder(length=500.0, radius=1250.0)
    path = sweep(Trait.APPROACH, [-5.0, 0.0], 1.0) >> LoadPath((Slide((0.0, 2.0), 1.0, HELD),))
    return Scene(Body(Flat.facing(surface), lower), Body(surface, upper), (law,), path, pairing)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"lower": BODY, "pairing": Lattice(2.0)}, "pairing"),
        ({"law": HardWall(), "pairing": Lattice(2.0)}, "effects"),
        ({"law": NormalCohesiveZone(2.0)}, "effects"),
        ({"law": NormalCohesiveZone(2.0), "pairing": Lattice(2.0)}, "effects"),
    ],
)
def test_what_cannot_be_joined_or_slid_is_refused(change, key):
    with pytest.raises(InputError, match=key):
        sliding(**change)


@pytest.mark.parametrize(
    "options",
    [
        {"lattice_constant": 0.0},
        {"lattice_constant": 2.0, "tangential_cutoff": -1.0},
        {"lattice_constant": 2.0, "normal_cutoff": 0.0},
    ]
    + [{"lattice_constant": 2.0, "weight": float("nan")}, {"lattice_constant": True}],
)
def test_options_of_a_lattice_are_checked(options):
    with pytest.raises(InputError, match="a positive number"):
        Lattice(**options)


def test_a_slide_needs_something_held_and_comes_last():
    with pytest.raises(InputError, match="held"):
        LoadStep(Trait.SLIDE, 1.0)
    with pytest.raises(InputError, match="held"):
        LoadStep(Trait.APPROACH, 1.0, held=HELD)
    with pytest.raises(InputError, match="presses first"):
        LoadPath((Slide((0.0, 1.0), 1.0, HELD),)) >> approaches([1.0])


def test_springs_to_other_sites_are_as_long_as_that_where_no_site_moves():
    surface, path = Flat(length=500.0), approaches([-1.0])
    bodies = Body(surface), Body(surface, Layer(70.0, 0.5, 500.0))
    scene = Scene(*bodies, CohesiveZone(2.0), path, Lattice(0.5))
    assert scene.components == ("n", "t")
    data = simulate(scene, points=64, tolerance=1e-9)
    assert -float(data.mean_pressure[0]) == pytest.approx(
        CohesiveZone(2.0).strength * spring_sum(0.0, 0.5)[0], rel=1e-9
    )


def test_a_scene_that_slides_has_a_tangential_gap_even_where_nothing_couples():
    scene = sliding(upper=replace(BODY, poisson_ratio=0.5), law=CohesiveZone(2.0))
    assert scene.components == ("n", "t")
    assert Trait.SLIDE in scene.traits
    problem = pose_cohesive(scene, scene.heights(64), 1e-7).at(scene.path.steps[-1])
    np.testing.assert_array_equal(problem.gap(np.zeros(problem.unknowns, complex))[1], 2.0)


def test_a_scene_that_does_not_slide_has_no_lattice():
    scene = replace(sliding(), path=approaches([0.0]))
    assert not scene.sliding
    assert scene.pairing is ALIGNED
    problem = pose_cohesive(scene, scene.heights(64), 1e-7)
    assert problem.law is LAW


def test_pressing_steps_have_no_slide():
    assert [step.sliding_distance for step in pressures([0.1]).steps] == [0.0]
    assert [step.sliding_distance for step in LoadPath((Slide((0.0, 1.0), 0.5, HELD),)).steps] == [0.0, 0.5, 1.0]
