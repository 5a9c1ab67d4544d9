"""Look up how much neglecting an effect changes a scene, in maps that were measured.

The maps are kept in a file of the package, measured by `contactsim.evaluation.effects.survey`. For a scene whose place
lies between those of a map, the largest change at the corners around it counts; beyond the axes nothing is known. What
is on no axis, such as how deep a surface is pressed, matters less: a map proposes, and a check on the scene itself
decides (`contactsim.error_control.neglect`).
"""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from contactsim.contact.scene import Scene
from contactsim.contact.simplification import simplify
from contactsim.elasticity.registry import ELASTICITIES
from contactsim.error_control.solution import Solution, relative_difference, solve_setup
from contactsim.grid import Array
from contactsim.interface.pairing import ALIGNED
from contactsim.interface.registry import EFFECTS
from contactsim.paths.options import Setup
from contactsim.surfaces.registry import SURFACES
from contactsim.traits import Trait

FILE = Path(__file__).with_name("effect_maps.json")
CLOSE = 1e-3
"""Part of a value by which it may miss one of a map's and count as that."""


def neglect_effects(setup: Setup, effects: Sequence[str]) -> Setup:
    """Return a setup without some effects of its scene."""
    return Setup(simplify(setup.scene, effects), setup.options)


def change_without(
    setup: Setup, effects: Sequence[str], quantities: Sequence[str], solutions: dict[str, Solution] | None = None
) -> float:
    """Return the largest relative change of quantities on neglecting effects.

    Parameters
    ----------
    setup : Setup
        Scene with all its effects, and options.
    effects : sequence of str
        Effects to neglect, together.
    quantities : sequence of str
        Quantities to compare.
    solutions : dict, optional
        Solutions by the fingerprint of their setup, which is added to.

    Returns
    -------
    float
        Infinite where the scene has none of the quantities.
    """
    solutions = {} if solutions is None else solutions
    full, simple = (_solve_once(neglect_effects(setup, names), quantities, solutions) for names in ([], effects))
    if all(np.isnan(solution.values[name]).all() for solution in (full, simple) for name in quantities):
        return np.inf
    return max(float(relative_difference(full, simple, name).max()) for name in quantities)


def _solve_once(setup: Setup, quantities: Sequence[str], solutions: dict[str, Solution]) -> Solution:
    """Return the solution of a setup, one for all with the same fingerprint."""
    key = setup.fingerprint
    if key not in solutions:
        solutions[key] = solve_setup(setup, quantities)
    return solutions[key]


@cache
def effect_maps() -> dict[str, dict[str, Any]]:
    """Return the maps of the package."""
    return dict(json.loads(FILE.read_text(encoding="utf-8")))


def expected_change(scene: Scene, effect: str) -> float | None:
    """Return the largest relative change that the maps expect without an effect; None where none knows it."""
    maps = [section for section in effect_maps().values() if section["neglect"] == [effect]]
    changes = [_read_map(scene, section) for section in maps if _applies(scene, section)]
    return max((change for change in changes if change is not None), default=None)


def _applies(scene: Scene, section: Mapping[str, Any]) -> bool:
    """Return True where a map is about such scenes: that surface, bodies and effects, pressed by approach, not slid."""
    by_pressure = scene.path.increment is not None and Trait.MEAN_PRESSURE in scene.traits
    if scene.pairing != ALIGNED or scene.sliding or by_pressure:
        return False
    described = (
        _kind_name(SURFACES, scene.upper.surface),
        [_kind_name(EFFECTS, effect) for effect in scene.effects],
        [_kind_name(ELASTICITIES, body) for body in scene.elasticities],
    )
    return described == (section["surface"], section["effects"], section["bodies"])


def _kind_name(registry: Mapping[str, type], item: object) -> str | None:
    """Return the name of a class in its registry."""
    return next((name for name, kind in registry.items() if type(item) is kind), None)


def _read_map(scene: Scene, section: Mapping[str, Any]) -> float | None:
    """Return the largest change at the corners of a map around a scene; None beyond it."""
    table = np.reshape(section["change"], [len(axis["values"]) for axis in section["axes"].values()])
    corners = []
    for axis in section["axes"].values():
        value, *units = (_scene_value(scene, key) for key in (axis["key"], *axis["per"]))
        divisors = [unit for unit in units if unit is not None]
        if value is None or len(divisors) < len(units):
            return None
        corner = _around(np.array(axis["values"]), value / math.prod(divisors))
        if corner is None:
            return None
        corners.append(corner)
    return max(float(table[corner]) for corner in itertools.product(*corners))


def _scene_value(scene: Scene, key: str) -> float | None:
    """Return the value of a dotted key, such as `body.poisson_ratio`, of a scene; None where it has none."""
    part, _, name = key.partition(".")
    owners: dict[str | None, object] = {
        "surface": scene.upper.surface,
        "body": scene.lower.elasticity,
        "counter_body": scene.upper.elasticity,
    }
    owners |= {_kind_name(EFFECTS, effect): effect for effect in scene.effects}
    return getattr(owners.get(part), name, None)


def _around(values: Array, value: float) -> tuple[int, ...] | None:
    """Return the places beside a value, or its own; None beyond all."""
    near = np.flatnonzero(np.isclose(values, value, rtol=CLOSE, atol=1e-12))
    if near.size:
        return (int(near[0]),)
    after = int(np.searchsorted(values, value))
    return (after - 1, after) if 0 < after < values.size else None
