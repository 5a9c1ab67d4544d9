"""Measure how much neglecting an effect changes: maps over some settings of a scene.

A map varies some settings of one scene, as they are or as ratios of settings. What is measured becomes the file that
`contactsim.error_control.effect_maps` reads.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr
import yaml

from contactsim import dataset
from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.error_control.effect_maps import change_without
from contactsim.error_control.relations import FILE as RELATIONS
from contactsim.errors import InputError, is_number
from contactsim.grid import Array
from contactsim.interface.registry import EFFECTS
from contactsim.provenance import digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.keys import any_of
from contactsim.study.kinds import study_kind
from contactsim.study.reading import Key, keys_of, listed, mapping, number, pair, read, size, text, tiered
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.study import Study

KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "maps": Key(mapping, "a mapping from names to maps"),
    "panels": Key(listed(mapping), "a list of mappings with map, across, up and at"),
}
MAP_KEYS = {
    "title": Key(text, "a line of text"),
    "neglect": Key(any_of(SIMPLIFICATIONS), f"a list from {', '.join(SIMPLIFICATIONS)}"),
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
PLACE = Key(pair, "where the words are written: two parts of the panel, across and up")


def read_maps(folder: str | Path, over: dict, tier: str) -> dict | None:
    """Return the settings of effect_maps.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / "effect_maps.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings = read(section, KEYS, file)
    settings["maps"] = {name: _read_map(name, entry, file) for name, entry in settings["maps"].items()}
    settings["panels"] = [
        _read_panel(panel, count, settings["maps"], file) for count, panel in enumerate(settings["panels"])
    ]
    return settings


def _read_map(name: str, section: object, file: str) -> dict:
    """Return the checked settings of a map, down to the scenes of all values of its axes."""
    prefix = f"maps.{name}"
    settings = read(section, MAP_KEYS, file, prefix)
    settings["axes"] = {
        axis: read(axis_settings, AXIS_KEYS, file, f"{prefix}.axes.{axis}")
        for axis, axis_settings in settings["axes"].items()
    }
    if not settings["axes"]:
        raise InputError(f"{prefix}.axes", {}, "at least one axis", file)
    for axis, axis_settings in settings["axes"].items():
        head, _, tail = axis_settings["key"].partition(".")
        if head not in settings["scene"] or (tail and not isinstance(settings["scene"][head], dict)):
            raise InputError(f"{prefix}.axes.{axis}.key", axis_settings["key"], "a key of the map's scene", file)
        for key in axis_settings["per"]:
            if not is_number(_value_at(settings["scene"], key)):
                raise InputError(f"{prefix}.axes.{axis}.per", key, "keys of the map's scene that hold numbers", file)
    first = {axis: axis_settings["values"][0] for axis, axis_settings in settings["axes"].items()}
    for axis, axis_settings in settings["axes"].items():
        for value in axis_settings["values"]:
            runs = _read_study(settings, first | {axis: value}, name, file).runs()
    if len(runs) != 1:
        raise InputError(f"{prefix}.scene", f"{len(runs)} runs", "one: nothing varied, one member", file)
    comparable = study_kind(runs[0].settings).comparable
    for quantity in settings["of"]:
        if quantity not in comparable:
            raise InputError(f"{prefix}.of", quantity, f"some of {', '.join(comparable)}", file)
    return settings


def _read_panel(section: dict, count: int, maps: Mapping, file: str) -> dict:
    """A panel as read: every axis of its map is across, up, or at a value of its own."""
    prefix = f"panels.{count}"
    panel = read(section, PANEL_KEYS, file, prefix)
    if panel["map"] not in maps:
        raise InputError(f"{prefix}.map", panel["map"], f"one of {', '.join(maps)}", file)
    axes = maps[panel["map"]]["axes"]
    named = [panel["across"], panel["up"], *panel["at"]]
    if sorted(named) != sorted(axes):
        raise InputError(prefix, named, f"each axis of the map once: {', '.join(axes)}", file)
    panel["conditions"] = read(
        panel["conditions"], dict.fromkeys(panel["conditions"], PLACE), file, f"{prefix}.conditions"
    )
    for axis, value in panel["at"].items():
        if value not in axes[axis]["values"]:
            raise InputError(f"{prefix}.at.{axis}", value, f"one of {axes[axis]['values']}", file)
    return panel


def map_job(settings: dict, name: str) -> dict:
    """Return what the measurement of one map depends on."""
    code = computing_stage_digest("measure_effect_map", *(solver_module(name) for name in DEFAULT_SOLVERS.values()))
    return {"name": name, "map": settings["maps"][name], "source": digest(code, RELATIONS.read_text(encoding="utf-8"))}


def maps_figure_job(settings: dict, tier: str) -> dict:
    """Return what the figure of all maps depends on."""
    figure = {key: settings[key] for key in ("title", "caption", "size", "panels")}
    titles = {name: entry["title"] for name, entry in settings["maps"].items()}
    data = digest([map_job(settings, name) for name in settings["maps"]])
    return {
        "settings": figure,
        "titles": titles,
        "tier": tier,
        "source": stage_digest("maps_figure"),
        "data": data,
    }


def measure_map(name: str, settings: dict) -> xr.Dataset:
    """Measure one map.

    Parameters
    ----------
    name : str
        Name of the map.
    settings : dict
        Its section, from `read_maps`.

    Returns
    -------
    xarray.Dataset
        Largest relative change of the map's quantities, with one dimension an axis; infinite where a path has no
        solution.
    """
    axes, solutions = settings["axes"], {}
    errors = np.empty([len(axis["values"]) for axis in axes.values()])
    for place in np.ndindex(errors.shape):
        values = {
            axis: axis_settings["values"][k] for (axis, axis_settings), k in zip(axes.items(), place, strict=True)
        }
        setup = _read_study(settings, values, name, "effect_maps.yaml").runs()[0].setup
        errors[place] = change_without(setup, settings["neglect"], settings["of"], solutions)
    return map_dataset(settings, errors)


def map_dataset(settings: dict, errors: Array) -> xr.Dataset:
    """Return the changes of a map with the values of its axes."""
    axes = {axis: axis_settings["values"] for axis, axis_settings in settings["axes"].items()}
    return dataset.describe(xr.Dataset({"change_without": (list(axes), errors)}, axes))


def _read_study(settings: dict, values: Mapping[str, float], name: str, file: str) -> Study:
    """Return the study of one run at one place of a map."""
    section = settings["scene"]
    for axis, value in values.items():
        axis_settings = settings["axes"][axis]
        section = _replace_value(
            section, axis_settings["key"], value * math.prod(_value_at(section, key) for key in axis_settings["per"])
        )
    return Study.read(name, {"title": name} | section, file, 0)


def _value_at(section: Mapping, key: str) -> object:
    """Return the value of a dotted key of a study's section; a law's default where it is not given, else None."""
    head, _, tail = key.partition(".")
    value = section.get(head)
    if not tail or not isinstance(value, Mapping):
        return None if tail else value
    keys = keys_of(EFFECTS[head]) if head in EFFECTS else {}
    return value.get(tail, keys[tail].default if tail in keys else None)


def _replace_value(section: dict, key: str, value: float) -> dict:
    """Return a section with another value of a dotted key."""
    head, _, tail = key.partition(".")
    return section | {head: _replace_value(section[head], tail, value) if tail else value}


def format_maps(maps: Mapping[str, xr.Dataset], settings: dict) -> str:
    """Return the maps as the text of the file that the package keeps."""
    sections = {}
    for name, data in maps.items():
        entry = settings["maps"][name]
        scene = entry["scene"]
        sections[name] = {
            "neglect": entry["neglect"],
            "of": entry["of"],
            "surface": scene["surface"]["kind"],
            "effects": scene["effects"],
            "bodies": [scene[part]["kind"] for part in ("body", "counter_body") if part in scene],
            "axes": entry["axes"],
            "change": [float(f"{value:.3g}") for value in data.change_without.values.ravel()],
        }
    head = (
        "# Change on neglecting effects, measured by `snakemake export_effect_maps`; see evaluation/effects/survey.py\n"
    )
    return head + yaml.safe_dump(sections, sort_keys=False, width=120, default_flow_style=None)
