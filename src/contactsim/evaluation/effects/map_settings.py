"""Settings of the maps: the scene, its axes, what is neglected, and the panels of their figure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.errors import InputError, Words, is_number
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.interface.registry import EFFECTS
from contactsim.study.keys import any_of
from contactsim.study.kind_quantities import KIND_QUANTITIES
from contactsim.study.kinds import problem_kind
from contactsim.study.reading import SAFE_NAME, SAFE_NAME_FORM, Key, keys_of, listed, mapping, number, pair, read, text
from contactsim.study.study import Study
from contactsim.study.tier_overrides import tiered

KEYS = FIGURE_KEYS | {
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


@dataclass(frozen=True)
class Axis:
    """A dotted key of the scene and its values, counted in the product of other keys."""

    key: str
    per: Sequence[str]
    values: Sequence[float]


@dataclass(frozen=True)
class EffectMap:
    """A map: the neglected effects, the compared quantities, the keys of its scene, and its axes by name.

    The order of the axes is that of the dimensions of its dataset.
    """

    title: str
    neglect: Sequence[str]
    of: Sequence[str]
    scene: Mapping[str, Any]
    axes: Mapping[str, Axis]

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> EffectMap:
        """Return the map from its checked section or the JSON of its job."""
        axes = {name: Axis(**axis) for name, axis in settings["axes"].items()}
        return cls(**{**settings, "axes": axes})

    def study(self, values: Mapping[str, float], name: str, file: object) -> Study:
        """Return the study of one run at the values of some axes; name and file: for messages."""
        section = dict(self.scene)
        for axis_name, value in values.items():
            axis = self.axes[axis_name]
            unit = math.prod(_number_at(section, key) for key in axis.per)
            section = _replace_value(section, axis.key, value * unit)
        try:
            return Study.read(name, {"title": name} | section, file, 0, [])
        except InputError as error:
            raise error.renamed(f"studies.{name}.", f"maps.{name}.scene.") from error


@dataclass(frozen=True)
class Panel:
    """A panel of the figure: a map, its axes across and up, values of its other axes, and places of words."""

    map: str
    across: str
    up: str
    at: Mapping[str, float]
    conditions: Mapping[str, Sequence[float]]


@dataclass(frozen=True)
class EffectMaps(FigureSettings):
    """All maps by name, and the panels of their figure."""

    maps: Mapping[str, EffectMap]
    panels: Sequence[Panel]


def read_maps(folder: str | Path, over: dict, tier: str) -> EffectMaps | None:
    """Return the settings of effect_maps.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / "effect_maps.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings = read(section, KEYS, file)
    for name in settings["maps"]:
        if not SAFE_NAME.fullmatch(name):
            raise InputError("maps", name, SAFE_NAME_FORM, file)
    maps = {name: _read_map(name, entry, file) for name, entry in settings["maps"].items()}
    panels = [_read_panel(panel, count, maps, file) for count, panel in enumerate(settings["panels"])]
    return EffectMaps(**settings | {"maps": maps, "panels": panels})


def _read_map(name: str, section: object, file: object) -> EffectMap:
    """Return a map, checked down to the scenes of all values of its axes."""
    prefix = f"maps.{name}"
    settings = read(section, MAP_KEYS, file, prefix)
    axes = {axis: read(part, AXIS_KEYS, file, f"{prefix}.axes.{axis}") for axis, part in settings["axes"].items()}
    if not axes:
        raise InputError(f"{prefix}.axes", {}, "at least one axis", file)
    effect_map = EffectMap.from_settings(settings | {"axes": axes})
    _check_axes(effect_map, file, prefix)
    first = {axis_name: axis.values[0] for axis_name, axis in effect_map.axes.items()}
    for axis_name, axis in effect_map.axes.items():
        for value in axis.values:
            runs = effect_map.study(first | {axis_name: value}, name, file).runs()
    if len(runs) != 1:
        raise InputError(f"{prefix}.scene", Words(f"{len(runs)} runs"), "one: nothing varied, one member", file)
    comparable = KIND_QUANTITIES[problem_kind(runs[0].settings["effects"])].comparable
    for quantity in effect_map.of:
        if quantity not in comparable:
            raise InputError(f"{prefix}.of", quantity, f"some of {', '.join(comparable)}", file)
    return effect_map


def _check_axes(effect_map: EffectMap, file: object, prefix: str) -> None:
    """Refuse an axis whose key the scene lacks, or that is counted in something other than numbers."""
    for name, axis in effect_map.axes.items():
        head, _, tail = axis.key.partition(".")
        if head not in effect_map.scene or (tail and not isinstance(effect_map.scene[head], dict)):
            raise InputError(f"{prefix}.axes.{name}.key", axis.key, "a key of the map's scene", file)
        for key in axis.per:
            if not is_number(_value_at(effect_map.scene, key)):
                raise InputError(f"{prefix}.axes.{name}.per", key, "keys of the map's scene that hold numbers", file)


def _read_panel(section: dict, count: int, maps: Mapping[str, EffectMap], file: object) -> Panel:
    """Return a panel; every axis of its map is across, up, or at a value of its own."""
    prefix = f"panels.{count}"
    panel = Panel(**read(section, PANEL_KEYS, file, prefix))
    if panel.map not in maps:
        raise InputError(f"{prefix}.map", panel.map, f"one of {', '.join(maps)}", file)
    axes = maps[panel.map].axes
    names = [panel.across, panel.up, *panel.at]
    if sorted(names) != sorted(axes):
        raise InputError(prefix, names, f"each axis of the map once: {', '.join(axes)}", file)
    places = read(panel.conditions, dict.fromkeys(panel.conditions, PLACE), file, f"{prefix}.conditions")
    for axis, value in panel.at.items():
        if value not in axes[axis].values:
            raise InputError(f"{prefix}.at.{axis}", value, f"one of {axes[axis].values}", file)
    return replace(panel, conditions=places)


def _value_at(section: Mapping, key: str) -> object:
    """Return the value of a dotted key of a study's section; a law's default where it is not set, else None."""
    head, _, tail = key.partition(".")
    value = section.get(head)
    if not tail or not isinstance(value, Mapping):
        return None if tail else value
    keys = keys_of(EFFECTS[head]) if head in EFFECTS else {}
    return value.get(tail, keys[tail].default if tail in keys else None)


def _number_at(section: Mapping, key: str) -> float:
    """Return the number of a dotted key of a study's section, which `_check_axes` has found to be one."""
    value = _value_at(section, key)
    assert isinstance(value, int | float)
    return value


def _replace_value(section: dict, key: str, value: float) -> dict:
    """Return a section with another value of a dotted key."""
    head, _, tail = key.partition(".")
    return section | {head: _replace_value(section[head], tail, value) if tail else value}
