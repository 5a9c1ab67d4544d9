"""Increments and tolerance for a wanted error: what can be chosen for each kind of problem, beside its grid."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.error_control.relations import Family, Relation
from contactsim.error_control.scaling import (
    PATH,
    ROUGH_PATH,
    SLIDE,
    contact_scale,
    features,
    scene_family,
    shortest_range,
)
from contactsim.errors import InputError, Words
from contactsim.paths.adaptive import Adaptive
from contactsim.paths.increments import Increments
from contactsim.paths.nested import Nested
from contactsim.paths.options import Setup
from contactsim.paths.requested import Requested
from contactsim.traits import Trait

GRID, EXPECTED = ("points",), ("points", "increment")
"""Knobs whose error is expected from relations: of the grid alone, and of all."""
ERROR_SHARES = {"increment": 0.2, "tolerance": 0.1}
"""Parts of the error that other knobs may make."""
PATH_TOLERANCE = 1e-4
"""Tolerance on paths, in parts of the strength: a looser one costs more, as states are then sought by flow."""
WALL_TOLERANCES = (1e-4, 1e-2)
"""Least and largest tolerance at a hard wall, in grid steps."""
MIN_POWER = 0.3
"""Powers of a knob below it count as none."""
MAX_INCREMENTS = {PATH: 2.0, ROUGH_PATH: 1.0, SLIDE: 1.0}
"""Longest increment of a path, in the laws' length: at most the longest that was measured. On longer ones rough lines
may come to another branch, a few per cent away."""
PEAK_INCREMENTS = {SLIDE: 1.8}
"""Longest increment of a path, in the laws' length, over the root of the wanted error. A largest force between states
is missed by the square of the increment. Shorter increments hardly cost more, as slips are located."""
CONTACT_POINTS = {SLIDE: 0.6}
"""Least points for the half-width of the contact, times the root of the wanted error."""
MIN_PRESSING_INCREMENT = 0.5
"""Least increment (nm) of the path that presses before a slide: that of the slides that were measured."""


class Knobs(Protocol):
    """Options that can be chosen for one kind of problem, beside its grid."""

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

    def expect_error(self, setup: Setup, family: Family, name: str, knobs: Sequence[str]) -> float:
        """Return the largest relative error of a quantity that these knobs, of `EXPECTED`, are expected to leave."""
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

    def expect_error(self, setup: Setup, family: Family, name: str, knobs: Sequence[str]) -> float:
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
        name_of_family = scene_family(scene)
        longest = min(MAX_INCREMENTS[name_of_family], PEAK_INCREMENTS.get(name_of_family, math.inf) * math.sqrt(error))
        increment = float(f"{shortest_range(scene) * math.exp(min([*logarithms, math.log(longest)])):.2g}")
        try:
            setup = setup.with_increment(increment, pressing=max(increment, MIN_PRESSING_INCREMENT))
        except InputError as too_many:
            raise InputError("accuracy", error, f"an error for which increments are {too_many.allowed}") from too_many
        return setup.with_options(tolerance=min(PATH_TOLERANCE, error * PATH_TOLERANCE / 1e-2))

    def scale_increment(self, setup: Setup, factor: float) -> Setup:
        """Return the setup with the increments of its slide or path times a factor, in three digits."""
        return setup.with_increment(float(f"{path_increment(setup.scene) * factor:.3g}"))

    def choose_tolerance(self, setup: Setup, family: Family, names: Sequence[str], error: float) -> Setup:
        """Return the setup itself: the tolerance has been chosen with the increments."""
        return setup

    def suit_grid(self, setup: Setup) -> Setup:
        """Return the setup with increments as requested, adaptive or, for rough lines, on nested grids."""
        return setup.with_options(increments=choose_increments(setup.scene, setup.points))

    def contact_scales(self, scene: Scene) -> list[float]:
        """Return one length (nm) for the whole path."""
        return [contact_scale(scene)]

    def expect_error(self, setup: Setup, family: Family, name: str, knobs: Sequence[str]) -> float:
        """Return the error that the knobs leave together."""
        scene = setup.scene
        (numbers,) = grid_features(scene, setup.points)
        numbers |= {"increment": math.log(path_increment(scene) / shortest_range(scene))}
        relations = [family.errors[knob][name] for knob in knobs if name in family.errors[knob]]
        return sum(relation(numbers) for relation in relations)


KNOBS: dict[ProblemKind, Knobs] = {ProblemKind.HARD_WALL: LoadKnobs(), ProblemKind.COHESIVE: PathKnobs()}


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


def path_increment(scene: Scene) -> float:
    """Return the increment of a path; raise InputError for one of single steps."""
    increment = scene.path.increment
    if increment is None:
        raise InputError("path", Words("single steps"), "a path through turning points, with an increment")
    return increment


def choose_increments(scene: Scene, points: int) -> Increments:
    """Return the increments of a path of cohesive laws on a grid of that many points."""
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
