"""What leaving effects out changes, as maps tell it that were measured over the numbers that govern it.

The maps are kept in a file of the package, measured by `contactsim.evaluation.effects.survey`. Of a scene whose place
lies between
those of a map, the largest change at the corners around it counts; of one beyond its axes nothing is known. What is on
no axis, such as how deep a surface is pressed, a map takes to matter less: it proposes, and a check on the scene itself
decides (`contactsim.error_control.neglect`).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from contactsim.error_control.control import Outcome, difference, outcome
from contactsim.grid import Array
from contactsim.interface.registry import EFFECTS
from contactsim.provenance import digest
from contactsim.study.reading import keys_of, load_yaml
from contactsim.study.scenes import scene_of

FILE = Path(__file__).with_name("effect_maps.yaml")


def change(run: dict, names: list[str], of: list[str], known: dict[str, Outcome] | None = None) -> float:
    """The largest relative change of quantities on leaving effects out of a run; infinite where it has none of them.

    known: solutions by digest of what they depend on, which is added to.
    """
    known = {} if known is None else known
    with_all, without = (_solved(run | {"leave_out": left}, of, known) for left in ([], names))
    if all(np.isnan(one.values[name]).all() for one in (with_all, without) for name in of):
        return np.inf
    return max(float(difference(with_all, without, name).max()) for name in of)


def _solved(run: dict, of: list[str], known: dict[str, Outcome]) -> Outcome:
    """The solution of a run, one for all whose scenes are the same."""
    key = reduced(run)
    if key not in known:
        known[key] = outcome({name: value for name, value in run.items() if name != "accuracy"}, of)
    return known[key]


def reduced(run: dict) -> str:
    """A digest of a run's scene as it acts, of its grid and path: runs with the same give the same."""
    scene = scene_of(run)
    rest = (
        "surface",
        "points",
        "tolerance",
        "load",
        "slide",
        "pairing",
        "increments",
        "solver",
        "seed",
        "study",
        "member",
    )
    bodies = [body.elasticity for body in (scene.lower, scene.upper)]
    acts = scene.components == ("n",)
    if acts:  # of bodies in which nothing moves along the surface
        bodies = [body if body is None or body.base_depth < math.inf else body.contact_modulus for body in bodies]
    told = [repr(scene.acting), repr(bodies), getattr(scene.upper.surface, "smoothed", None)]
    return digest(told, {name: run[name] for name in rest if name in run})


@cache
def maps() -> dict:
    """The maps of the package."""
    return load_yaml(FILE)


def expected(run: dict, effect: str) -> float | None:
    """The largest relative change that the maps expect of a run without an effect; None where none knows it."""
    found = [_read(run, one) for one in maps().values() if one["leave_out"] == [effect] and _applies(run, one)]
    known = [value for value in found if value is not None]
    return max(known, default=None)


def _applies(run: dict, one: Mapping) -> bool:
    """Whether a map is about such scenes: of that surface, of such bodies, with these effects, pressed and not slid."""
    bodies = [run[part]["kind"] for part in ("body", "counter_body") if run.get(part)]
    if run.get("pairing") or run.get("slide") or run["load"].get("control", "approach") != "approach":
        return False
    return (one["surface"], one["effects"], one["bodies"]) == (run["surface"]["kind"], run["effects"], bodies)


def _read(run: dict, one: Mapping) -> float | None:
    """The largest change at the corners of a map around a run; None beyond it."""
    table = np.reshape(one["change"], [len(axis["values"]) for axis in one["axes"].values()])
    corners = []
    for axis in one["axes"].values():
        value, unit = value_at(run, axis["key"]), product(run, axis["per"])
        known = value is not None and unit is not None
        place = _around(np.array(axis["values"]), value / unit) if known else None
        if place is None:
            return None
        corners.append(place)
    return max(float(table[corner]) for corner in itertools.product(*corners))


def value_at(section: Mapping, key: str) -> object:
    """The value of a dotted key of a study's section; a law's own where none is given, None where there is none."""
    head, _, tail = key.partition(".")
    found = section.get(head)
    if not tail or not isinstance(found, Mapping):
        return None if tail else found
    known = keys_of(EFFECTS[head]) if head in EFFECTS else {}
    return found.get(tail, known[tail].default if tail in known else None)


def product(section: Mapping, keys: list[str]) -> float | None:
    """The product of the values of dotted keys; None where one is missing."""
    found = [value_at(section, key) for key in keys]
    return None if None in found else math.prod(found)


CLOSE = 1e-3
"""Part of a value by which it may miss one of a map's and count as that."""


def _around(values: Array, value: float) -> tuple[int, ...] | None:
    """The places beside a value, or its own; None beyond all."""
    near = np.flatnonzero(np.isclose(values, value, rtol=CLOSE, atol=1e-12))
    if near.size:
        return (int(near[0]),)
    after = int(np.searchsorted(values, value))
    return (after - 1, after) if 0 < after < values.size else None
