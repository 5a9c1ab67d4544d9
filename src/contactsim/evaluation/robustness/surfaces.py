"""Cases of surfaces that get harder: from severity 0 to 100, and what is right at each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from contactsim.evaluation.robustness.cases import (
    Case,
    flat_pressure,
    make_case,
    nearly_incompressible_ratio,
    point_pressure,
    push_to_approach,
    shift_field,
    summit_pressure,
)
from contactsim.grid import Array
from contactsim.surfaces.self_affine import SelfAffine, realisation_seed

SIDE = 64


def _rough(side: int = SIDE) -> Array:
    """A self-affine surface of rms gradient 1 whose shortest wavelength is eight points."""
    return SelfAffine(side, 0.8, side / 4, 8.0, 1.0, dimensions=2, seed=realisation_seed(5, 0.8)).heights(side)


def _hilly(shape: tuple[int, int], along: tuple[float, float] = (1.5, 1.5)) -> Array:
    """Noise smoothed over that many points along y and x, of unit rms."""
    noise = np.random.default_rng(shape).normal(size=shape)
    waves = [2 * np.pi * np.fft.fftfreq(size) * length for size, length in zip(shape, along, strict=True)]
    smooth = np.fft.ifft2(np.fft.fft2(noise) * np.exp(-sum(np.square(wave) for wave in np.ix_(*waves)) / 2)).real
    return smooth / smooth.std()


def light_surface(severity: float) -> Case:
    """The load on a rough surface falls from p* = 1e-2 to 1e-7, until one point carries all of it."""
    heights, load = _rough(), 10 ** (-2 - severity / 20)
    return Case(heights, load, exact=point_pressure(heights, load))


def surface_first_touch(severity: float) -> Case:
    """The approach is prescribed, from one spacing down to 1e-8 beyond first touch.

    The tolerance falls with it: an overlap within the tolerance is no touch.
    """
    heights, depth = _rough(), 10 ** (-8 * severity / 100)
    heights -= heights.max()
    return Case(heights, approach=depth, tolerance=1e-4 * depth, exact=point_pressure(heights, depth=depth))


def nearly_full_surface(severity: float) -> Case:
    """A rough surface just short of complete contact, by a tenth of the load down to one part in a million."""
    flat = flat_pressure(_rough(), Case(_rough()).compliance)
    return make_case(flat - flat.min() * (1 - 10 ** (-1 - severity / 20)))


def surface_last_gap(severity: float) -> Case:
    """The approach is prescribed, up to a millionth of the load short of complete contact."""
    case = nearly_full_surface(severity)
    return Case(case.heights, approach=0.0, tolerance=1e-8, exact=case.exact)


def full_surface(severity: float) -> Case:
    """A rough surface in complete contact, beyond the load that it takes by a factor of 1e6 down to 1 + 1e-6."""
    heights = _rough()
    flat = flat_pressure(heights, Case(heights).compliance)
    load = -flat.min() * (1 + 10 ** (6 - 12 * severity / 100))
    return Case(heights, load, exact=load + flat)


def flat_punch(severity: float) -> Case:
    """The surroundings of a flat round top fall, from 1 to 1e7 spacings below: its answer stays.

    The edge carries most; the answer is by elimination. The tolerance falls with the depth: it stays the same length.
    """
    away = np.arange(SIDE) - SIDE // 2
    depth = 10 ** (7 * severity / 100)
    heights = np.where(np.hypot(away[:, None], away) <= 8.2, 0.0, -depth)
    return Case(
        heights, 1e-3, tolerance=1e-5 / depth, exact=summit_pressure(heights, 1e-3), mirror=(SIDE // 2, SIDE // 2)
    )


def _post(height: float) -> Case:
    """One point out of a plane."""
    heights = np.zeros((33, 33))
    heights[10, 20] = height
    return Case(heights, 1e-3, exact=point_pressure(heights, 1e-3), mirror=(10, 20))


def tall_post(severity: float) -> Case:
    """A single point sticks out of a plane, ten to ten million spacings high: it carries the load."""
    return _post(10 ** (1 + 6 * severity / 100))


def low_post(severity: float) -> Case:
    """A single point sticks out of a plane, from ten spacings to 1e-4; the plane begins to carry."""
    return _post(10 ** (1 - severity / 20))


def deep_hole(severity: float) -> Case:
    """A single point that is not in contact falls, to 1e8 spacings: the contact does not notice."""
    case = make_case(shift_field(_rough(), 0.1), tolerance=1e-6)
    heights = case.heights.copy()
    heights.flat[np.argmin(_rough())] -= 10 ** (1 + 7 * severity / 100)
    return replace(case, heights=heights)


def chequerboard(severity: float) -> Case:
    """Noise up to the Nyquist wavenumbers takes over; at last the pressure alternates both ways."""
    if severity >= 100:
        return make_case((-1.0) ** np.add.outer(np.arange(SIDE), np.arange(SIDE)))
    share = severity / 100
    noise = np.random.default_rng(1).normal(size=(SIDE, SIDE))
    return make_case(shift_field((1 - share) * _rough() / 10 + share * noise, 0.3))


def grazing_surface(severity: float) -> Case:
    """Ever more points, up to all but a tenth, neither carry nor gape: the contact is undecided."""
    field = shift_field(_rough() / 10, 0.1)
    return make_case(np.where(field < np.quantile(field, 0.9 * (1 - severity / 100)), field, np.maximum(field, 0.0)))


def wide_range(severity: float) -> Case:
    """Pressures and gaps of a surface spread over ever more decades, up to twenty of them."""
    field = shift_field(_hilly((SIDE, SIDE)), 0.2)
    return make_case(field * np.abs(field) ** (4 * severity / 100))


def far_surface(severity: float) -> Case:
    """A surface's zero moves away from it, by 1 to 1e8 spacings: rounding, and nothing else, changes."""
    case = make_case(shift_field(_rough(), 0.1), tolerance=1e-4)
    return Case(case.heights + 10 ** (8 * severity / 100), case.mean_pressure, exact=case.exact)


def ridges(severity: float) -> Case:
    """Hills grow along y, from as long as wide to ridges that do not end: at last a line in two dimensions."""
    field = _hilly((SIDE, SIDE), (1.5 * 10 ** (severity / 50), 1.5))
    return make_case(shift_field(field if severity < 100 else np.tile(field[:1], (SIDE, 1)), 0.2))


def oblong_cells(severity: float) -> Case:
    """The spacing along x grows, from that along y to a thousand times it."""
    return make_case(shift_field(_hilly((SIDE, SIDE)), 0.2), spacing=(1.0, 10 ** (3 * severity / 100)))


def oblong_grid(severity: float) -> Case:
    """The same number of points in ever fewer rows, from 64 of 64 to 2 of 2048."""
    rows = 2 ** round(6 - 5 * severity / 100)
    return make_case(shift_field(_hilly((rows, SIDE**2 // rows)), 0.2))


def awkward_grids(severity: float) -> Case:
    """2 × 2, 2 × 3, 3 × 3 … points, then ever larger odd and prime numbers of them."""
    shapes = (
        (2, 2),
        (2, 3),
        (3, 3),
        (5, 3),
        (4, 7),
        (13, 7),
        (31, 2),
        (3, 67),
        (17, 31),
        (65, 64),
        (61, 67),
        (113, 127),
    )
    shape = shapes[round(severity / 100 * (len(shapes) - 1))]
    return make_case(shift_field(_hilly(shape, (0.5, 0.5)), 0.4))


def incompressible_surface_layer(severity: float) -> Case:
    """In a layer a tenth of the roll-off wavelength thick, ν rises from 0.3 to exactly 0.5."""
    ratio = nearly_incompressible_ratio(severity)
    return make_case(shift_field(_rough(), 0.1), thickness=SIDE / 40, poisson_ratio=ratio)


def thin_incompressible_surface_layer(severity: float) -> Case:
    """A layer of ν = 0.5 gets thinner, from the roll-off wavelength to 1e-3 of it."""
    return make_case(shift_field(_rough(), 0.1), thickness=SIDE / 4 * 10 ** (-3 * severity / 100), poisson_ratio=0.5)


def pushed_surface_layer(severity: float) -> Case:
    """The approach to a layer of ν = 0.3 is prescribed, to a million times complete contact's."""
    case = Case(_rough(), thickness=SIDE / 4, poisson_ratio=0.3)
    flat = flat_pressure(case.heights, case.compliance)  # of mean zero, as the heights
    return push_to_approach(case, flat, severity)


def tight_surface_tolerance(severity: float) -> Case:
    """The tolerance on a surface falls from 1e-2 to 1e-18 grid steps, below what rounding allows."""
    return make_case(shift_field(_rough(), 0.1), tolerance=10 ** (-2 - 16 * severity / 100))


SURFACES = (
    light_surface,
    surface_first_touch,
    nearly_full_surface,
    surface_last_gap,
    full_surface,
    flat_punch,
    tall_post,
    low_post,
    deep_hole,
    chequerboard,
    grazing_surface,
    wide_range,
    far_surface,
    ridges,
    oblong_cells,
    oblong_grid,
    awkward_grids,
    incompressible_surface_layer,
    thin_incompressible_surface_layer,
    pushed_surface_layer,
    tight_surface_tolerance,
)
"""In the order of the map."""
