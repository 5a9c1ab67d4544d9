"""Measure how much neglecting an effect changes: maps over some settings of a scene.

A map varies some settings of one scene, as they are or as ratios of settings. What is measured becomes the file that
`contactsim.error_control.effect_maps` reads.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.error_control.effect_maps import change_without
from contactsim.error_control.scaling import FILE as RELATIONS
from contactsim.error_control.solution import Solution
from contactsim.evaluation.effects.map_settings import EffectMap, EffectMaps
from contactsim.grid import Array
from contactsim.provenance import digest
from contactsim.solvers.registry import DEFAULT_SOLVERS, solver_module
from contactsim.study.stages import computing_stage_digest, stage_digest


@dataclass(frozen=True)
class MapJob:
    """The measurement of one map: its name and the map."""

    name: str
    map: EffectMap

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> MapJob:
        """Return the job from its JSON, of `map_job`."""
        return cls(settings["name"], EffectMap.from_settings(settings["map"]))


def map_job(maps: EffectMaps, name: str) -> dict[str, Any]:
    """Return what the measurement of one map depends on."""
    code = computing_stage_digest("measure_effect_map", *(solver_module(name) for name in DEFAULT_SOLVERS.values()))
    job = asdict(MapJob(name, maps.maps[name]))
    return job | {"source": digest(code, RELATIONS.read_text(encoding="utf-8"))}


def maps_figure_job(maps: EffectMaps, tier: str) -> dict[str, Any]:
    """Return what the figure of all maps depends on."""
    return {
        "settings": maps.layout | {"panels": [asdict(panel) for panel in maps.panels]},
        "titles": {name: entry.title for name, entry in maps.maps.items()},
        "tier": tier,
        "source": stage_digest("maps_figure"),
        "data": digest([map_job(maps, name) for name in maps.maps]),
    }


def measure_map(job: MapJob) -> xr.Dataset:
    """Measure one map.

    Parameters
    ----------
    job : MapJob
        The map and its name.

    Returns
    -------
    xarray.Dataset
        Largest relative change of the map's quantities, with one dimension an axis; infinite where a path has no
        solution.
    """
    axes = job.map.axes
    solutions: dict[str, Solution] = {}
    errors = np.empty([len(axis.values) for axis in axes.values()])
    for place in np.ndindex(errors.shape):
        values = {name: axis.values[k] for (name, axis), k in zip(axes.items(), place, strict=True)}
        setup = job.map.study(values, job.name, "effect_maps.yaml").runs()[0].setup
        errors[place] = change_without(setup, job.map.neglect, job.map.of, solutions)
    return map_dataset(job.map, errors)


def map_dataset(effect_map: EffectMap, errors: Array) -> xr.Dataset:
    """Return the changes of a map with the values of its axes."""
    axes = {name: list(axis.values) for name, axis in effect_map.axes.items()}
    return dataset.describe(xr.Dataset({"change_without": (list(axes), errors)}, axes))


def format_maps(maps: Mapping[str, EffectMap], changes: Mapping[str, xr.Dataset]) -> str:
    """Return maps and their measured changes, both by name, as the text of the package's file, a line each."""
    sections = {}
    for name, data in changes.items():
        settings = asdict(maps[name])
        scene = settings["scene"]
        sections[name] = {
            "neglect": settings["neglect"],
            "of": settings["of"],
            "surface": scene["surface"]["kind"],
            "effects": scene["effects"],
            "bodies": [scene[part]["kind"] for part in ("body", "counter_body") if part in scene],
            "axes": settings["axes"],
            "change": [float(f"{value:.3g}") for value in data.change_without.values.ravel()],
        }
    return "{\n" + ",\n".join(f'"{name}": {json.dumps(section)}' for name, section in sections.items()) + "\n}\n"
