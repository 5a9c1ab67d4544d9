"""Area and gradient of a contact without the first-order error of the grid: exact contacts, then rough ones."""

import numpy as np
import pytest

import contactsim as cs
from contactsim.observables.contact import contact_edges, touching
from contactsim.observables.edge_correction import EDGE_EXCESS, ContactGradient, corrected_area, edge_points
from contactsim.reference import hard_wall
from contactsim.surfaces.squared_gradient import squared_gradient


def gradient_of(slopes, contact, area):
    """The rms gradient of squared slopes over a contact of a line."""
    return ContactGradient.of([(slice(0, 1), slopes[None])], contact).within(area)


def test_a_full_and_an_empty_contact_have_no_edges():
    slopes = np.full(16, 4.0)
    assert corrected_area(np.ones(16, bool)) == 1
    assert gradient_of(slopes, np.ones(16, bool), 1.0) == 2
    assert corrected_area(np.zeros(16, bool)) == 0
    assert gradient_of(0 * slopes, np.ones(16, bool), 1.0) == 0  # flat
    assert np.isnan(gradient_of(slopes, np.zeros(16, bool), 0.0))


def test_edge_points_touch_a_neighbour_without_contact():
    contact = np.zeros((8, 8), bool)
    contact[2:6, 2:6] = True
    edge = contact.copy()
    edge[3:5, 3:5] = False
    assert (edge_points(contact) == edge).all()


def test_what_the_area_lacks_is_taken_from_the_edges():
    contact = np.arange(10) < 6
    slopes = np.where(np.arange(10) % 5 == 0, 9.0, 1.0)  # steep at both edges
    lost = 2 * EDGE_EXCESS[1]
    expected = (4 * 1.0 + (2 - lost) * 9.0) / (6 - lost)
    assert gradient_of(slopes, contact, corrected_area(contact)) == pytest.approx(np.sqrt(expected), rel=1e-14)


@pytest.mark.parametrize("shape", [(256,), (64, 64), (49, 64), (98, 64)])
def test_the_squared_gradient_of_waves_is_exact(shape):
    phase = 2 * np.pi * np.arange(shape[-1]) / shape[-1]
    across = 2 * np.pi * np.arange(shape[0])[:, None] / shape[0]
    heights = np.sin(5 * phase) if len(shape) == 1 else np.sin(5 * phase) * np.cos(5 * across)
    exact = (5 * np.cos(5 * phase)) ** 2
    if len(shape) == 2:
        exact = exact * np.cos(5 * across) ** 2 + (5 * np.sin(5 * phase) * np.sin(5 * across)) ** 2
    lengths = (2 * np.pi,) * len(shape)
    assert np.allclose(squared_gradient(heights, lengths, 5), exact, atol=1e-11)
    assert not np.allclose(squared_gradient(heights, lengths), exact, atol=1e-3)  # differences


def test_the_squared_gradient_of_a_parabola_is_exact_inside():
    x = np.arange(101) - 50.0
    assert np.allclose(squared_gradient(x**2 / 2, (101.0,))[1:-1], x[1:-1] ** 2)


def sphere_contact(radius, offset, points=512):
    """Points in contact of a sphere under the load of Hertz's contact radius, in points."""
    along = np.arange(points) - points // 2
    heights = -((along[:, None] - offset[0]) ** 2 + (along - offset[1]) ** 2) / 2e6
    pressure = 4 / 3 * radius**3 / 1e6 / points**2
    result = cs.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=pressure, tolerance=1e-4)
    return touching(np.asarray(result.pressure))


def test_the_mean_excess_at_the_edge_of_spheres_is_the_constant():
    generator = np.random.default_rng(17)  # other spheres than those that the constant was measured on
    excess = []
    for radius in generator.uniform(6, 20, 40):
        contact = sphere_contact(radius, generator.uniform(-0.5, 0.5, 2))
        excess.append((np.count_nonzero(contact) - np.pi * radius**2) / contact_edges(contact))
    error = np.std(excess, ddof=1) / np.sqrt(len(excess))
    assert error < 0.006  # the literature's 0.1181 is told apart
    assert abs(np.mean(excess) - EDGE_EXCESS[2]) < 3 * error


def test_the_mean_area_of_cylinders_is_exact_and_the_counted_one_is_not():
    lengths = np.linspace(4e6, 4.3e6, 200)  # the edge falls on other places between points
    counted, corrected = [], []
    for length in lengths:
        load = 1e6 * 0.2**2 * np.pi / 4  # c/R = 0.2
        scene = cs.Scene(
            cs.HalfSpace(contact_modulus=1.0), cs.Cylinder(length, 1e6), cs.HardWall(), cs.pressures([load / length])
        )
        data = cs.simulate(scene, points=512)
        exact = 2 * hard_wall.cylinder_array_half_width(load, 1e6, length, 1.0) / length
        counted.append(data.relative_contact_area.item() / exact - 1)
        corrected.append(data.relative_contact_area_corrected.item() / exact - 1)
    error = np.std(corrected, ddof=1) / np.sqrt(len(corrected))
    assert abs(np.mean(corrected)) < 3 * error
    assert np.mean(counted) > 5 * error


@pytest.mark.parametrize("dimensions", [1, 2])
def test_corrected_factors_of_rough_contacts_change_least_with_the_grid(dimensions):
    waves = {1: 4096, 2: 32}[dimensions]
    surface = cs.SelfAffine(
        length=float(waves), hurst_exponent=0.5, long_cutoff=waves / 4, short_cutoff=1.0, rms_gradient=1e-3, seed=4,
        dimensions=dimensions,
    )  # fmt: skip
    scene = cs.Scene(cs.HalfSpace(contact_modulus=1.0), surface, cs.HardWall(), cs.pressures([3e-5]))
    coarse, fine = (cs.simulate(scene, points=waves * points).isel(step=0) for points in (8, 32))

    def change(area, gradient):
        """Relative change of κ_r from 8 to 32 points per shortest wavelength."""
        return abs((coarse[area] * coarse[gradient] / (fine[area] * fine[gradient])).item() - 1)

    area, gradient = "relative_contact_area", "rms_gradient_contact"
    assert change(f"{area}_corrected", f"{gradient}_corrected") < change(area, gradient) / 3
