"""Grid, tolerance and increments for an accuracy that is asked for, before anything runs.

They follow from relations that were measured (`contactsim.error_control.scaling`). An accuracy is a relative error of a
run's
quantities; each knob gets its share of it. What is chosen here is where a run begins;
`contactsim.error_control.control` finds out
whether it was right.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contactsim.contact.scene import Scene
from contactsim.error_control.scaling import (
    LINE,
    MEASURES,
    PATH,
    ROUGH_PATH,
    SLIDE,
    SURFACE,
    Kind,
    Relation,
    contact_scale,
    features,
    kind_of,
    reach_of,
    relations,
)
from contactsim.errors import SceneError
from contactsim.study.keys import is_smooth
from contactsim.study.scenes import scene_of
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.traits import Trait

SAFETY = {LINE: 0.5, SURFACE: 0.75, PATH: 0.65, ROUGH_PATH: 0.4, SLIDE: 0.7}
"""Part of an error that the grid is chosen for: less where scenes of a kind differ more than what is known of them."""
SHARES = {"increment": 0.2, "tolerance": 0.1}
"""Parts of the error that other knobs may make."""
SIZES = (8, 9, 10, 12, 15)
"""Points of a grid are one of these times a power of two: short transforms, and blocks of eight."""
FEWEST = 16
"""Least points of a grid; a run has twice as many, as its companion has fewer."""
LARGEST = 2**28
"""Most points of a grid that an accuracy may lead to."""
PACE = 3.0
"""Increments of a companion, over those of its run."""
COARSER = {LINE: 5.0}
"""How many times coarser the companion of a run is than what is expected to be needed, if not three times."""
PATH_TOLERANCE = 1e-4
"""Tolerance on paths, in parts of the strength: one that is looser costs more, as states are then sought by flow."""
TOLERANCES = (1e-4, 1e-2)
"""Least and largest tolerance at a wall, in grid steps."""
FLAT = 0.3
"""Powers of a knob below it count as none."""
LONGEST = 2.0
"""Longest increment of a path, in the laws' length."""
PRESSING = 0.5
"""Least increment, nm, of the path that presses before a slide: that of the slides that were measured, see `draws`."""
WAVES = 2.5
"""Least points for each shortest wavelength."""


def at_least(points: float) -> int:
    """The smallest grid with that many points that the transforms like."""
    exponent = max(math.ceil(math.log2(max(points, FEWEST) / SIZES[-1])), 0)
    sizes = [size * 2**power for size in SIZES for power in range(exponent + 2) if size * 2**power >= FEWEST]
    return min(size for size in sizes if size >= points)


def chosen(settings: dict, error: float, of: Sequence[str] = ()) -> dict:
    """A run's settings with the grid, tolerance and increments for a relative error of quantities.

    settings: of a run, whose path may have any increments; of: names of quantities, the usual ones where empty.
    """
    scene = scene_of(settings)
    kind = kind_of(scene)
    known, names = relations().kinds[kind], of or MEASURES[kind]
    for name in names:
        if name not in known.errors["points"]:
            raise SceneError("accuracy.of", name, f"some of {', '.join(known.errors['points'])}")
    found = dict(settings)
    if is_smooth(settings):
        found |= _paced(settings, scene, known, names, error)
        found["tolerance"] = min(PATH_TOLERANCE, error * PATH_TOLERANCE / 1e-2)
        try:
            scene = scene_of(found)
        except SceneError as too_many:
            raise SceneError("accuracy", error, f"an error for which increments are {too_many.allowed}") from too_many
    scale = scales(scene)
    spacing = min(
        scale_of * math.exp(grid)
        for one, scale_of in zip(features(scene), scale, strict=True)
        for grid in _solved(known.errors["points"], names, "grid", one, SAFETY[kind] * error)
    )
    found["points"] = grid_for(scene, max(scene.length / spacing, 2 * FEWEST), error)
    if not is_smooth(settings):
        worst = [
            _solved(known.errors["tolerance"], names, "tolerance", one, SHARES["tolerance"] * error)
            for one in on_grid(scene, found["points"])
        ]
        found["tolerance"] = float(np.clip(math.exp(min(min(each) for each in worst)), *TOLERANCES))
    else:
        found["increments"] = walked(scene, kind, found["points"], settings)
    return found


def grid_for(scene: Scene, points: float, error: float) -> int:
    """The grid of about that many points which resolves the surface; SceneError where it is beyond all bounds."""
    surface = scene.upper.surface
    if isinstance(surface, SelfAffine):
        points = max(points, WAVES * surface.length / surface.finest)
    if not math.prod(surface.shape(at_least(min(points, LARGEST)))) <= LARGEST or points > LARGEST:
        raise SceneError("accuracy", error, f"an error for which {LARGEST:.2g} grid points are enough")
    return at_least(points)


def on_points(settings: dict, points: float, error: float = 0.0) -> dict:
    """A run's settings on a grid of about that many points, its path walked as suits it; error: see `grid_for`."""
    scene = scene_of(settings)
    found = settings | {"points": grid_for(scene, points, error)}
    if is_smooth(settings):
        found["increments"] = walked(scene, kind_of(scene), found["points"], found)
    return found


def coarser(settings: dict) -> dict:
    """The companion of a run: its grid and increments coarser."""
    ratio = COARSER.get(kind_of(scene_of(settings)), 3.0)
    paced = settings | rescaled(settings, PACE) if is_smooth(settings) else settings
    return on_points(paced, settings["points"] / ratio)


def paced_part(settings: dict) -> str:
    """The section of a run whose increment counts: that of its slide, or of its path."""
    return "slide" if settings.get("slide") else "load"


def by_increment(settings: dict, increment: float) -> dict:
    """The section of a run with such an increment."""
    part = paced_part(settings)
    return {part: settings[part] | {"increment": increment}}


def rescaled(settings: dict, factor: float) -> dict:
    """The section of a run with its increment times a factor."""
    return by_increment(settings, settings[paced_part(settings)]["increment"] * factor)


def size_of(scene: Scene, points: int) -> int:
    """All points of a grid with that many along x."""
    return math.prod(scene.upper.surface.shape(points))


def _solved(
    laws: dict[str, Relation], names: Sequence[str], knob: str, one: dict[str, float], target: float
) -> list[float]:
    """The logarithm of a knob at which the errors of quantities are on a target, as far as they depend on it."""
    found = []
    for name in names:
        law = laws.get(name)
        if law is None or not law.coefficients.get(knob, 0.0) > FLAT:
            continue
        rest = math.log(law(one | {knob: 0.0}))
        found.append((math.log(target) - rest) / law.coefficients[knob])
    return found


def scales(scene: Scene) -> list[float]:
    """The length that contacts are measured by, for each set of features, nm."""
    if Trait.WALL in scene.traits:
        return [contact_scale(scene, step.value) for step in scene.path.steps]
    return [contact_scale(scene)]


def left_open(settings: dict, known: Kind, name: str) -> float:
    """The relative error of a quantity of a path that its grid and increments are expected to leave."""
    scene = scene_of(settings)
    (place,) = on_grid(scene, settings["points"])
    increment = settings[paced_part(settings)]["increment"]
    place |= {"increment": math.log(increment / reach_of(scene))}
    laws = [known.errors[knob][name] for knob in ("points", "increment") if name in known.errors[knob]]
    return sum(law(place) for law in laws)


def on_grid(scene: Scene, points: int) -> list[dict[str, float]]:
    """Features with the grid's: spacing over what contacts are measured by; and the number of points."""
    spacing, size = scene.length / points, size_of(scene, points)
    return [
        one | {"grid": math.log(spacing / scale), "size": math.log(size)}
        for one, scale in zip(features(scene), scales(scene), strict=True)
    ]


def _paced(settings: dict, scene: Scene, known: Kind, names: Sequence[str], error: float) -> dict:
    """The sections of a run with the increments of its path for an error."""
    (one,) = features(scene)
    found = _solved(known.errors["increment"], names, "increment", one, SHARES["increment"] * error)
    increment = float(f"{reach_of(scene) * math.exp(min([*found, math.log(LONGEST)])):.2g}")
    return by_increment(settings, increment) | _pressed(settings, increment)


def _pressed(settings: dict, increment: float) -> dict:
    """The path that presses before a slide, in increments of its own, as nothing is read off it."""
    return {"load": settings["load"] | {"increment": max(increment, PRESSING)}} if settings.get("slide") else {}


def walked(scene: Scene, kind: str, points: int, settings: dict) -> dict:
    """How a path is walked on a grid."""
    if kind == SLIDE or scene.path.steps[0].control is not Trait.APPROACH:
        return {"kind": "requested"}
    if kind != ROUGH_PATH:
        return {"kind": "adaptive"}
    waves = points * contact_scale(scene) / scene.length
    ratio = 2 ** int(np.clip(round(math.log2(waves / 2)), 0, 4))
    while points % (2 * ratio):
        ratio //= 2
    settled = sorted(set(settings["load"]["through"][1:]))
    return {"kind": "nested", "settled": settled, "ratio": ratio, "between": min(2, ratio)}
