"""Choose grid, tolerance and increments for a wanted error, before anything runs.

They follow from measured relations between error and cost (`contactsim.error_control.relations`). The wanted error is a
relative error of a run's quantities, of which each knob gets a share. `contactsim.error_control.control` then solves
and finds out whether the choice was right.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from contactsim.error_control.grids import MIN_POINTS, choose_grid
from contactsim.error_control.knobs import CONTACT_POINTS, EXPECTED, KNOBS, solve_relations
from contactsim.error_control.measured import choose_measured, is_measured, sample_every_second
from contactsim.error_control.relations import Family, scaling_relations
from contactsim.error_control.scaling import (
    LINE,
    PATH,
    QUANTITIES,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    contact_scale,
    features,
    scene_family,
)
from contactsim.error_control.stepwise import begin_stepwise, has_relations
from contactsim.errors import InputError
from contactsim.paths.options import Setup

SAFETY = {LINE: 0.45, SURFACE: 0.75, PATH: 0.6, ROUGH_PATH: 0.4, SLIDE: 0.7}
"""Part of an error that the grid is chosen for, as random scenes ask for."""
COARSE_INCREMENT_RATIOS = {LINE: 1.0, SURFACE: 1.0, PATH: 3.0, ROUGH_PATH: 2.0, SLIDE: 1.0}
"""Increments of a coarse companion, over those of its run; of slides the same, as states tell what they leave."""
COARSE_GRID_RATIOS = {LINE: 7.0, SURFACE: 3.0, PATH: 5.0, ROUGH_PATH: 6.0, SLIDE: 3.0}
"""Ratio of the grid that is expected to be needed to the companion's."""


SECOND_COARSE_GRID_RATIOS = {SLIDE: 1.7}
"""The same of a second companion."""


def choose_options(setup: Setup, error: float, quantities: Sequence[str] = ()) -> Setup:
    """Choose grid, tolerance and increments for a relative error.

    Parameters
    ----------
    setup : Setup
        Scene and options; its grid, tolerance and increments do not matter.
    error : float
        Relative error, above 0 and below 1.
    quantities : sequence of str, optional
        Quantities whose error counts; those usual for the scene where empty.

    Returns
    -------
    Setup
        The same scene, its path in other increments, with options for that error.

    Raises
    ------
    InputError
        For a quantity or a scene without a relation, or where no affordable grid is fine enough.
    """
    scene = setup.scene
    if is_measured(scene):
        return choose_measured(setup, quantities)
    if not has_relations(scene):
        return begin_stepwise(setup, error, quantities)
    name_of_family = scene_family(scene)
    family, names = scaling_relations().families[name_of_family], quantities or QUANTITIES[name_of_family]
    for name in names:
        if name not in family.errors["points"]:
            raise InputError("accuracy.quantities", name, f"some of {', '.join(family.errors['points'])}")
    knobs = KNOBS[scene.kind]
    setup = knobs.choose_increment(setup, family, names, error)
    scene = setup.scene
    spacing = min(
        scale * math.exp(logarithm)
        for numbers, scale in zip(features(scene), knobs.contact_scales(scene), strict=True)
        for logarithm in solve_relations(
            family.errors["points"], names, "grid", numbers, SAFETY[name_of_family] * error
        )
    )
    if name_of_family in CONTACT_POINTS:
        spacing = min(spacing, contact_scale(scene) / CONTACT_POINTS[name_of_family] * math.sqrt(error))
    points = choose_grid(scene, max(scene.length / spacing, 2 * MIN_POINTS), error)
    setup = knobs.choose_tolerance(setup.with_options(points=points), family, names, error)
    return knobs.suit_grid(setup)


def set_grid(setup: Setup, points: float, error: float = 0.0) -> Setup:
    """Return a setup on a grid of about that many points, its path followed as suits it; error: see `choose_grid`."""
    setup = setup.with_options(points=choose_grid(setup.scene, points, error))
    return KNOBS[setup.scene.kind].suit_grid(setup)


def scale_increment(setup: Setup, factor: float) -> Setup:
    """Return a setup with the increments of its slide or path times a factor; unchanged where there are none."""
    return KNOBS[setup.scene.kind].scale_increment(setup, factor)


def coarsen(setup: Setup) -> Setup:
    """Return the coarse companion of a setup: a coarser grid and, on paths without a slide, longer increments."""
    if is_measured(setup.scene):
        return sample_every_second(setup)
    family = scene_family(setup.scene)
    setup = scale_increment(setup, COARSE_INCREMENT_RATIOS[family])
    return set_grid(setup, setup.points / COARSE_GRID_RATIOS[family])


def choose_companions(setup: Setup) -> list[Setup]:
    """Return the coarser runs that a setup is compared with, the coarsest first: one, or two of a slide."""
    ratio = SECOND_COARSE_GRID_RATIOS.get(scene_family(setup.scene))
    return [coarsen(setup), *([set_grid(setup, setup.points / ratio)] if ratio else [])]


def expect_error(setup: Setup, family: Family, name: str, knobs: Sequence[str] = EXPECTED) -> float:
    """Return the largest relative error of a quantity that knobs, grid and increments, are expected to leave."""
    return KNOBS[setup.scene.kind].expect_error(setup, family, name, knobs)
