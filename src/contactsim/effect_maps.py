"""Maps of what leaving an effect out changes, over the numbers that govern it; and what they say of a scene.

A map varies some settings of one scene, as they are or as ratios of settings. It is measured by the workflow and kept
in a file of the package. Of a scene whose place lies between those of a map, the largest change at the corners around
it counts; of one beyond its axes nothing is known. What is on no axis, such as how deep a surface is pressed, a map
takes to matter less: it proposes, and a check on the scene itself decides (`contactsim.negligible`).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
import xarray as xr
import yaml

from contactsim import dataset
from contactsim.build import scene_of
from contactsim.config import Key, listed, load_yaml, mapping, number, overlaid, read, size, text
from contactsim.confirm import Outcome, difference, outcome
from contactsim.errors import SceneError
from contactsim.grid import Array
from contactsim.leaving_out import LEFT_OUT
from contactsim.provenance import digest, source_digest
from contactsim.relations import FILE as RELATIONS
from contactsim.schema import some_of
from contactsim.solvers import USUAL, module_of
from contactsim.study import Study

FILE = Path(__file__).with_name("effect_maps.yaml")
KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "maps": Key(mapping, "a mapping from names to maps"),
    "panels": Key(listed(mapping), "a list of mappings with map, across, up and at"),
}
MAP_KEYS = {
    "title": Key(text, "a line of text"),
    "leave_out": Key(some_of(LEFT_OUT), f"a list from {', '.join(LEFT_OUT)}"),
    "of": Key(listed(text), "a list of quantities"),
    "scene": Key(mapping, "the keys of a study with one run"),
    "axes": Key(mapping, "a mapping from names to a key of the scene and its values"),
}
AXIS_KEYS = {
    "key": Key(text, "a key of the scene, such as body.poisson_ratio"),
    "per": Key(listed(text), "a list of keys whose product it is counted in", []),
    "values": Key(listed(number), "a list of values"),
}
PANEL_KEYS = {
    "map": Key(text, "the name of a map"),
    "across": Key(text, "an axis of the map"),
    "up": Key(text, "an axis of the map"),
    "at": Key(mapping, "a mapping from the other axes to one of their values", {}),
    "conditions": Key(mapping, "a mapping from words to where they are written, across and up", {}),
}


def read_maps(folder: str | Path, over: dict) -> dict | None:
    """Settings of effect_maps.yaml, with what a tier changes; None without that file."""
    file = Path(folder) / "effect_maps.yaml"
    if not file.exists():
        return None
    settings = read(overlaid(load_yaml(file), over), KEYS, file)
    for name, section in settings["maps"].items():
        one = read(section, MAP_KEYS, file, f"maps.{name}")
        one["axes"] = {
            axis: read(given, AXIS_KEYS, file, f"maps.{name}.axes.{axis}") for axis, given in one["axes"].items()
        }
        settings["maps"][name] = one
        _run(one, {axis: given["values"][0] for axis, given in one["axes"].items()}, name, file)
    settings["panels"] = [
        _panel(panel, count, settings["maps"], file) for count, panel in enumerate(settings["panels"])
    ]
    return settings


def _panel(section: dict, count: int, maps: Mapping, file: Path) -> dict:
    """A panel as read: every axis of its map is across, up, or at a value of its own."""
    prefix = f"panels.{count}"
    panel = read(section, PANEL_KEYS, file, prefix)
    if panel["map"] not in maps:
        raise SceneError(f"{prefix}.map", panel["map"], f"one of {', '.join(maps)}", file)
    axes = maps[panel["map"]]["axes"]
    named = [panel["across"], panel["up"], *panel["at"]]
    if sorted(named) != sorted(axes):
        raise SceneError(prefix, named, f"each axis of the map once: {', '.join(axes)}", file)
    for axis, value in panel["at"].items():
        if value not in axes[axis]["values"]:
            raise SceneError(f"{prefix}.at.{axis}", value, f"one of {axes[axis]['values']}", file)
    return panel


def plan(settings: dict, name: str) -> dict:
    """What the measurement of one map depends on."""
    code = source_digest("contactsim.effect_maps", *(module_of(usual) for usual in USUAL.values()))
    return {"name": name, "map": settings["maps"][name], "source": digest(code, RELATIONS.read_text(encoding="utf-8"))}


def figure(settings: dict, tier: str) -> dict:
    """What the figure of all maps depends on."""
    shown = {key: settings[key] for key in ("title", "caption", "size", "panels")}
    titles = {name: one["title"] for name, one in settings["maps"].items()}
    data = digest([plan(settings, name) for name in settings["maps"]])
    return {
        "settings": shown,
        "titles": titles,
        "tier": tier,
        "source": source_digest("contactsim.figures.effect_maps"),
        "data": data,
    }


def measure(name: str, settings: dict) -> xr.Dataset:
    """One map: the largest relative change of its quantities, at every place; infinite where a path has no solution."""
    axes, known = settings["axes"], {}
    errors = np.empty([len(axis["values"]) for axis in axes.values()])
    for place in np.ndindex(errors.shape):
        values = {axis: given["values"][k] for (axis, given), k in zip(axes.items(), place, strict=True)}
        errors[place] = change(_run(settings, values, name, FILE), settings["leave_out"], settings["of"], known)
    return as_dataset(settings, errors)


def as_dataset(settings: dict, errors: Array) -> xr.Dataset:
    """A map's changes with the values of its axes."""
    axes = {axis: given["values"] for axis, given in settings["axes"].items()}
    return dataset.described(xr.Dataset({"change_without": (list(axes), errors)}, axes))


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


def _run(settings: dict, values: Mapping[str, float], name: str, file: Path) -> dict:
    """Settings of the run at one place of a map."""
    section = settings["scene"]
    for axis, value in values.items():
        given = settings["axes"][axis]
        section = _with(section, given["key"], value * _unit(section, given["per"]))
    return Study.read(name, {"title": name} | section, file, 0).runs()[0].settings


def _with(section: dict, key: str, value: float) -> dict:
    """A section with a dotted key set."""
    head, _, tail = key.partition(".")
    return section | {head: _with(section[head], tail, value) if tail else value}


DEFAULTS = {"normal_length": 1.0, "tangential_length": 1.0}


def _at(section: Mapping, key: str) -> float | None:
    """The value of a dotted key; None where there is none."""
    head, _, tail = key.partition(".")
    found = section.get(head)
    if tail and isinstance(found, Mapping):
        return _at(found, tail)
    return DEFAULTS.get(head) if found is None else None if tail else found


def _unit(section: Mapping, keys: list[str]) -> float | None:
    """The product of the values of dotted keys; None where one is missing."""
    found = [_at(section, key) for key in keys]
    return None if None in found else math.prod(found)


def as_text(maps: Mapping[str, xr.Dataset], settings: dict) -> str:
    """The maps as the package keeps them."""
    told = {}
    for name, data in maps.items():
        one = settings["maps"][name]
        scene = one["scene"]
        told[name] = {
            "leave_out": one["leave_out"],
            "of": one["of"],
            "surface": scene["surface"]["kind"],
            "effects": scene["effects"],
            "bodies": [scene[part]["kind"] for part in ("body", "counter_body") if part in scene],
            "axes": one["axes"],
            "change": [float(f"{value:.3g}") for value in data.change_without.values.ravel()],
        }
    head = "# What leaving effects out changes, measured by `snakemake freeze_maps`; see contactsim/effect_maps.py\n"
    return head + yaml.safe_dump(told, sort_keys=False, width=120, default_flow_style=None)


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
        value, unit = _at(run, axis["key"]), _unit(run, axis["per"])
        known = value is not None and unit is not None
        place = _around(np.array(axis["values"]), value / unit) if known else None
        if place is None:
            return None
        corners.append(place)
    return max(float(table[corner]) for corner in itertools.product(*corners))


CLOSE = 1e-3
"""Part of a value by which it may miss one of a map's and count as that."""


def _around(values: Array, value: float) -> tuple[int, ...] | None:
    """The places beside a value, or its own; None beyond all."""
    near = np.flatnonzero(np.isclose(values, value, rtol=CLOSE, atol=1e-12))
    if near.size:
        return (int(near[0]),)
    after = int(np.searchsorted(values, value))
    return (after - 1, after) if 0 < after < values.size else None
