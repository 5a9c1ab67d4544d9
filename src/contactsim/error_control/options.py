"""Choose grid, tolerance and increments for a wanted error, before anything runs.

They follow from measured relations between error and cost (`contactsim.error_control.scaling`). The wanted error is a
relative error of a run's quantities, of which each knob gets a share. `contactsim.error_control.control` then solves
and finds out whether the choice was right.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from contactsim.contact.scene import ProblemKind, Scene
from contactsim.error_control.scaling import (
    LINE,
    PATH,
    QUANTITIES,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    Family,
    Relation,
    contact_scale,
    features,
    scaling_relations,
    scene_family,
    shortest_range,
)
from contactsim.errors import InputError
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.increments import Increments, Requested
from contactsim.paths.nested import Nested
from contactsim.paths.options import Setup
from contactsim.traits import Trait

SAFETY = {LINE: 0.5, SURFACE: 0.75, PATH: 0.65, ROUGH_PATH: 0.4, SLIDE: 0.7}
"""Part of an error that the grid is chosen for: less where scenes of a family differ more from their relation."""
ERROR_SHARES = {"increment": 0.2, "tolerance": 0.1}
"""Parts of the error that other knobs may make."""
GRID_FACTORS = (8, 9, 10, 12, 15)
"""Points of a grid are one of these times a power of two: short transforms, and blocks of eight."""
MIN_POINTS = 16
"""Least points of a grid; a run has twice as many, as its coarse companion has fewer."""
MAX_POINTS = 2**28
"""Most points of a grid that a wanted error may lead to."""
COARSE_INCREMENT_RATIO = 3.0
"""Increments of a coarse companion, over those of its run."""
COARSE_GRID_RATIOS = {LINE: 5.0}
"""How many times coarser the companion's grid is than the one expected to be needed, where it is not three times."""
PATH_TOLERANCE = 1e-4
"""Tolerance on paths, in parts of the strength: a looser one costs more, as states are then sought by flow."""
WALL_TOLERANCES = (1e-4, 1e-2)
"""Least and largest tolerance at a hard wall, in grid steps."""
MIN_POWER = 0.3
"""Powers of a knob below it count as none."""
MAX_INCREMENT = 2.0
"""Longest increment of a path, in the laws' length."""
MIN_PRESSING_INCREMENT = 0.5
"""Least increment (nm) of the path that presses before a slide: that of the slides that were measured."""
POINTS_PER_WAVE = 2.5
"""Least points for each shortest wavelength."""


class Knobs(Protocol):
    """What can be chosen for one kind of problem, beside its grid."""

    def choose_increment(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup with the increments of its path for an error, and the tolerance that goes with them."""
        ...

    def scale_increment(self, setup: Setup, factor: float) -> Setup:
        """Return the setup with the increments of its path times a factor."""
        ...

    def choose_tolerance(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup with the tolerance for an error on its grid."""
        ...

    def suit_grid(self, setup: Setup) -> Setup:
        """Return the setup with its path followed as suits its grid."""
        ...

    def contact_scales(self, scene: Scene) -> list[float]:
        """Return the length (nm) that contacts are measured by, for each set of features."""
        ...

    def expect_error(self, setup: Setup, family: Family, name: str) -> float:
        """Return the largest relative error of a quantity that grid and increments are expected to leave."""
        ...


class LoadKnobs:
    """Grid and tolerance of loads at a hard wall; there are no increments."""

    def choose_increment(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup itself."""
        return setup

    def scale_increment(self, setup: Setup, factor: float) -> Setup:
        """Return the setup itself."""
        return setup

    def choose_tolerance(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup with the tolerance (grid steps) whose share of the error every load can bear."""
        target = ERROR_SHARES["tolerance"] * error
        worst = [
            min(solve_relations(family.errors["tolerance"], names, "tolerance", numbers, target))
            for numbers in grid_features(setup.scene, setup.points)
        ]
        return setup.with_options(tolerance=float(np.clip(math.exp(min(worst)), *WALL_TOLERANCES)))

    def suit_grid(self, setup: Setup) -> Setup:
        """Return the setup itself."""
        return setup

    def contact_scales(self, scene: Scene) -> list[float]:
        """Return a length (nm) for each load."""
        return [contact_scale(scene, step.value) for step in scene.path.steps]

    def expect_error(self, setup: Setup, family: Family, name: str) -> float:
        """Return the error that the grid leaves at the worst load."""
        return max(family.errors["points"][name](numbers) for numbers in grid_features(setup.scene, setup.points))


class PathKnobs:
    """Grid, tolerance and increments of a path of cohesive laws."""

    def choose_increment(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup with increments in two digits; of a path that slides, those of the slide."""
        scene = setup.scene
        (numbers,) = features(scene)
        target = ERROR_SHARES["increment"] * error
        logarithms = solve_relations(family.errors["increment"], names, "increment", numbers, target)
        increment = float(f"{shortest_range(scene) * math.exp(min([*logarithms, math.log(MAX_INCREMENT)])):.2g}")
        try:
            setup = setup.with_increment(increment, pressing=max(increment, MIN_PRESSING_INCREMENT))
        except InputError as too_many:
            raise InputError("accuracy", error, f"an error for which increments are {too_many.allowed}") from too_many
        return setup.with_options(tolerance=min(PATH_TOLERANCE, error * PATH_TOLERANCE / 1e-2))

    def scale_increment(self, setup: Setup, factor: float) -> Setup:
        """Return the setup with the increments of its slide or, without one, of its path times a factor."""
        return setup.with_increment(setup.scene.path.increment * factor)

    def choose_tolerance(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup itself: the tolerance has been chosen with the increments."""
        return setup

    def suit_grid(self, setup: Setup) -> Setup:
        """Return the setup with increments as requested, adaptive or, for rough lines, on nested grids."""
        return setup.with_options(increments=choose_increments(setup.scene, setup.points))

    def contact_scales(self, scene: Scene) -> list[float]:
        """Return one length (nm) for the whole path."""
        return [contact_scale(scene)]

    def expect_error(self, setup: Setup, family: Family, name: str) -> float:
        """Return the error that grid and increments leave together."""
        scene = setup.scene
        (numbers,) = grid_features(scene, setup.points)
        numbers |= {"increment": math.log(scene.path.increment / shortest_range(scene))}
        relations = [family.errors[knob][name] for knob in ("points", "increment") if name in family.errors[knob]]
        return sum(relation(numbers) for relation in relations)


KNOBS: dict[ProblemKind, Knobs] = {ProblemKind.HARD_WALL: LoadKnobs(), ProblemKind.COHESIVE: PathKnobs()}


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
    points = choose_grid(scene, max(scene.length / spacing, 2 * MIN_POINTS), error)
    setup = knobs.choose_tolerance(setup.with_options(points=points), family, names, error)
    return knobs.suit_grid(setup)


def round_grid(points: float) -> int:
    """Return the smallest grid with that many points that has short transforms."""
    exponent = max(math.ceil(math.log2(max(points, MIN_POINTS) / GRID_FACTORS[-1])), 0)
    sizes = [factor * 2**power for factor in GRID_FACTORS for power in range(exponent + 2)]
    return min(size for size in sizes if size >= max(points, MIN_POINTS))


def choose_grid(scene: Scene, points: float, error: float) -> int:
    """Return a grid of about that many points which resolves the surface.

    Raises
    ------
    InputError
        Where it has more than `MAX_POINTS` points in all; `error` is named as the cause.
    """
    surface = scene.upper.surface
    points = max(points, POINTS_PER_WAVE * scene.length / surface.effective_short_cutoff)
    if not math.prod(surface.shape(round_grid(min(points, MAX_POINTS)))) <= MAX_POINTS or points > MAX_POINTS:
        raise InputError("accuracy", error, f"an error for which {MAX_POINTS:.2g} grid points are enough")
    return round_grid(points)


def set_grid(setup: Setup, points: float, error: float = 0.0) -> Setup:
    """Return a setup on a grid of about that many points, its path followed as suits it; error: see `choose_grid`."""
    setup = setup.with_options(points=choose_grid(setup.scene, points, error))
    return KNOBS[setup.scene.kind].suit_grid(setup)


def scale_increment(setup: Setup, factor: float) -> Setup:
    """Return a setup with the increments of its slide or path times a factor; unchanged where there are none."""
    return KNOBS[setup.scene.kind].scale_increment(setup, factor)


def coarsen(setup: Setup) -> Setup:
    """Return the coarse companion of a setup: a coarser grid and longer increments."""
    ratio = COARSE_GRID_RATIOS.get(scene_family(setup.scene), 3.0)
    return set_grid(scale_increment(setup, COARSE_INCREMENT_RATIO), setup.points / ratio)


def expect_error(setup: Setup, family: Family, name: str) -> float:
    """Return the largest relative error of a quantity that grid and increments are expected to leave."""
    return KNOBS[setup.scene.kind].expect_error(setup, family, name)


def solve_relations(
    relations: Mapping[str, Relation], names: Sequence[str], knob: str, numbers: Mapping[str, float], target: float
) -> list[float]:
    """Return the logarithms of a knob at which the errors of quantities meet a target, as far as they depend on it."""
    logarithms = []
    for name in names:
        relation = relations.get(name)
        if relation is None or not relation.coefficients.get(knob, 0.0) > MIN_POWER:
            continue
        rest = math.log(relation({**numbers, knob: 0.0}))
        logarithms.append((math.log(target) - rest) / relation.coefficients[knob])
    return logarithms


def grid_features(scene: Scene, points: int) -> list[dict[str, float]]:
    """Return the features of a scene on a grid, for each load or for the path.

    Beside `scaling.features`: the logarithms of spacing over contact size, and of the number of points.
    """
    spacing, size = scene.length / points, math.prod(scene.upper.surface.shape(points))
    return [
        numbers | {"grid": math.log(spacing / scale), "size": math.log(size)}
        for numbers, scale in zip(features(scene), KNOBS[scene.kind].contact_scales(scene), strict=True)
    ]


def choose_increments(scene: Scene, points: int) -> Increments:
    """Return how the path of cohesive laws is followed on a grid of that many points."""
    family = scene_family(scene)
    if family == SLIDE or scene.path.steps[0].control is not Trait.APPROACH:
        return Requested()
    if family != ROUGH_PATH:
        return Adaptive()
    waves = points * contact_scale(scene) / scene.length
    ratio = 2 ** int(np.clip(round(math.log2(waves / 2)), 0, 4))
    while points % (2 * ratio):
        ratio //= 2
    return Nested(
        tuple(sorted(set(scene.path.turning_points[1:]))), coarse_ratio=ratio, intermediate_ratio=min(2, ratio)
    )
