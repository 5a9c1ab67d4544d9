"""Cases of lines that get harder: from severity 0 to 100, and what is right at each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contactsim.evaluation.robustness.cases import (
    Case,
    make_case,
    nearly_incompressible_ratio,
    point_pressure,
    push_to_approach,
    shift_field,
)
from contactsim.grid import Array
from contactsim.reference import hard_wall
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed

POINTS = 1024


def _rough(points: int = POINTS) -> Array:
    """A self-affine profile of rms gradient 1 whose shortest wavelength is eight points."""
    return SelfAffine(points, 0.8, points / 4, 8.0, 1.0, seed=realisation_seed(5, 0.8)).heights(points)


def _wave(points: int, ratio: float) -> Case:
    """A wave at p/p_c; the tolerance resolves the gap, which shrinks faster than the open part."""
    load = ratio * hard_wall.full_contact_pressure(1.0, points, 1.0)
    heights = np.cos(2 * np.pi * np.arange(points) / points)
    return Case(heights, load, tolerance=1e-6, area=float(hard_wall.sinusoid_area(ratio)), mirror=0)


def few_points(severity: float) -> Case:
    """The load on a rough line falls from p* = 1e-2 to 1e-7, until one point carries all of it."""
    heights, load = _rough(), 10 ** (-2 - severity / 20)
    return Case(heights, load, exact=point_pressure(heights, load))


def light_wave(severity: float) -> Case:
    """A wave touches ever more lightly, from half of full contact's load down to 5e-9 of it; area by Westergaard."""
    return _wave(POINTS, 0.5 * 10 ** (-8 * severity / 100))


def nearly_full_wave(severity: float) -> Case:
    """A wave opens ever less, up to 1e-5 short of full contact's load; area by Westergaard."""
    return _wave(POINTS, 1 - 0.5 * 10 ** (-severity / 100 * 4.7))


def nearly_full_rough(severity: float) -> Case:
    """A rough line just short of complete contact, by a tenth of the load down to one part in a million."""
    flat = hard_wall.complete_contact(_rough(), POINTS, 1.0)
    return make_case(flat - flat.min() * (1 - 10 ** (-1 - severity / 20)))


def full_contact(severity: float) -> Case:
    """A rough line in complete contact, beyond the load that it takes by a factor of 1e6 down to 1 + 1e-6."""
    heights = _rough()
    flat = hard_wall.complete_contact(heights, POINTS, 1.0)
    load = -flat.min() * (1 + 10 ** (6 - 12 * severity / 100))
    return Case(heights, load, exact=load + flat)


def equal_heights(severity: float) -> Case:
    """Ever more points are the highest, exactly equal, from one to every second; they share the load equally."""
    distance = 2 ** round(10 - 9 * severity / 100)
    teeth = np.where(np.arange(POINTS) % distance == 0, 1.0, 0.0)
    return Case(100 * teeth, 1e-3, exact=1e-3 * distance * teeth, mirror=0)


def tall_spike(severity: float) -> Case:
    """A single point sticks out of a plane, ten to ten million spacings high: it carries the load."""
    heights = np.zeros(257)
    heights[100] = 10 ** (1 + 6 * severity / 100)
    return Case(heights, 1e-3, exact=point_pressure(heights, 1e-3), mirror=100)


def _dug(severity: float, share: float) -> Case:
    """A rough line with a groove in its widest gap over that share of all points, 1e1 to 1e8 spacings deep."""
    case = make_case(shift_field(_rough(), 0.1), tolerance=1e-6)
    far = np.argmin(_rough()) + np.arange(round(share * POINTS))
    heights = case.heights.copy()
    heights[far % POINTS] -= 10 ** (1 + 7 * severity / 100)
    return replace(case, heights=heights)


def deep_pit(severity: float) -> Case:
    """A single point that is not in contact falls, to 1e8 spacings below the others: the contact does not notice."""
    return _dug(severity, 1 / POINTS)


def deep_groove(severity: float) -> Case:
    """A groove in a gap, over one point in fifty, gets ever deeper, to 1e8 spacings: the contact does not notice."""
    return _dug(severity, 0.02)


def low_spike(severity: float) -> Case:
    """A single point sticks out of a plane, from ten spacings to 1e-4, and the plane around it begins to carry."""
    heights = np.zeros(257)
    heights[100] = 10 ** (1 - severity / 20)
    return Case(heights, 1e-3, exact=point_pressure(heights, 1e-3), mirror=100)


def flat(severity: float) -> Case:
    """Ripples on a plane vanish, from a tenth of what the load flattens down to none: complete contact."""
    ripple = 0.0 if severity >= 100 else 0.1 * 10 ** (-severity / 5)
    heights = 7.0 + ripple * np.random.default_rng(0).uniform(-1, 1, 256)
    return Case(heights, 1.0, exact=1.0 + hard_wall.complete_contact(heights - 7.0, 256.0, 1.0))


def white_noise(severity: float) -> Case:
    """Noise up to the Nyquist wavenumber takes over the pressure, which at last alternates point by point."""
    if severity >= 100:
        return make_case((-1.0) ** np.arange(POINTS))
    share = severity / 100
    field = (1 - share) * _rough() / 10 + share * np.random.default_rng(1).normal(size=POINTS)
    return make_case(shift_field(field, 0.3))


def grazing(severity: float) -> Case:
    """Ever more points, up to all but a tenth, neither carry nor gape: the contact set is undecided there."""
    field = shift_field(_rough() / 10, 0.1)
    return make_case(np.where(field < np.quantile(field, 0.9 * (1 - severity / 100)), field, np.maximum(field, 0.0)))


def steep_slopes(severity: float) -> Case:
    """Slopes from 1e-3 to 1e3: answers are those of slope 1 in proportion (small slopes are assumed in the model)."""
    return make_case(shift_field(_rough(), 0.1), scale=10 ** (-3 + 6 * severity / 100))


def awkward_sizes(severity: float) -> Case:
    """2, 3, 5 … points, then ever larger odd and prime numbers of them."""
    sizes = (2, 3, 5, 7, 13, 31, 67, 127, 255, 509, 1021, 4093, 8191)
    size = sizes[round(severity / 100 * (len(sizes) - 1))]
    return make_case(
        np.cos(2 * np.pi * np.arange(size) / size) + 0.3 * np.random.default_rng(size).uniform(-1, 1, size)
    )


def units(severity: float) -> Case:
    """Lengths in units from 1e-12 to 1e12, and moduli the other way round."""
    return make_case(shift_field(_rough(), 0.1), unit=10 ** (-12 + 24 * severity / 100))


def far_datum(severity: float) -> Case:
    """The profile's zero moves away from it, by 1 to 1e8 spacings: rounding, and nothing else, changes."""
    case = make_case(shift_field(_rough(), 0.1), tolerance=1e-4)
    return Case(case.heights + 10 ** (8 * severity / 100), case.mean_pressure, exact=case.exact)


def first_touch(severity: float) -> Case:
    """The approach is prescribed, from one spacing down to 1e-8 beyond first touch of a rough line.

    The tolerance falls with it: an overlap within the tolerance is no touch.
    """
    heights, depth = _rough(), 10 ** (-8 * severity / 100)
    heights -= heights.max()
    return Case(heights, approach=depth, tolerance=1e-4 * depth, exact=point_pressure(heights, depth=depth))


def last_gap(severity: float) -> Case:
    """The approach is prescribed, up to where a millionth of the load is missing to complete contact."""
    case = nearly_full_rough(severity)
    return Case(case.heights, approach=0.0, tolerance=1e-8, exact=case.exact)


def thin_layer(severity: float) -> Case:
    """A layer of ν = 0.3 gets thinner, from the roll-off wavelength to 1e-4 of it: points yield each on their own."""
    return make_case(shift_field(_rough(), 0.1), thickness=POINTS / 4 * 10 ** (-severity / 25), poisson_ratio=0.3)


def incompressible_layer(severity: float) -> Case:
    """In a layer a tenth as thick as the roll-off wavelength, ν rises from 0.3 to exactly 0.5: the volume is fixed."""
    ratio = nearly_incompressible_ratio(severity)
    return make_case(shift_field(_rough(), 0.1), thickness=POINTS / 40, poisson_ratio=ratio)


def thin_incompressible_layer(severity: float) -> Case:
    """A layer of ν = 0.5 gets thinner, from the roll-off wavelength to 1e-3 of it: long waves meet no compliance."""
    return make_case(shift_field(_rough(), 0.1), thickness=POINTS / 4 * 10 ** (-3 * severity / 100), poisson_ratio=0.5)


def thick_layer(severity: float) -> Case:
    """A layer of ν = 0.3 gets thicker, from the roll-off wavelength to 1e12 spacings: at last it is a half-space."""
    return make_case(
        shift_field(_rough(), 0.1), thickness=POINTS / 4 * (4e12 / POINTS) ** (severity / 100), poisson_ratio=0.3
    )


def pushed_layer(severity: float) -> Case:
    """The approach to a layer of ν = 0.3 is prescribed, up to a million times that of complete contact."""
    case = Case(_rough(), thickness=POINTS / 4, poisson_ratio=0.3)
    flat = np.fft.irfft(np.fft.rfft(case.heights) / case.compliance)  # of mean zero, as the heights
    return push_to_approach(case, flat, severity)


def zero_load(severity: float) -> Case:
    """No load, on profiles from 1e-12 to 1e12 high: no contact, and no iteration."""
    return Case(_rough() * 10 ** (-12 + 24 * severity / 100), 0.0, exact=np.zeros(POINTS))


def tension(severity: float) -> Case:
    """A negative load, from -1e-12 to -1: nothing can pull, so it is refused."""
    return Case(_rough(), -(10 ** (-12 + 12 * severity / 100)), refuse=True)


def tight_tolerance(severity: float) -> Case:
    """The tolerance falls from 1e-2 to 1e-18 grid steps, below what rounding allows."""
    return make_case(shift_field(_rough(256), 0.1), tolerance=10 ** (-2 - 16 * severity / 100))


LINES = (
    few_points,
    light_wave,
    first_touch,
    nearly_full_wave,
    nearly_full_rough,
    last_gap,
    full_contact,
    equal_heights,
    tall_spike,
    deep_pit,
    deep_groove,
    low_spike,
    flat,
    white_noise,
    grazing,
    steep_slopes,
    awkward_sizes,
    units,
    far_datum,
    thin_layer,
    incompressible_layer,
    thin_incompressible_layer,
    thick_layer,
    pushed_layer,
    zero_load,
    tension,
    tight_tolerance,
)
"""In the order of the map."""
