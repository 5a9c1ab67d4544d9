"""Measure the cost of effects: one scene with all of them, and with some left out.

Unknowns, loads, transforms and the status of every step are reproducible; seconds and memory are kept apart.
"""

from __future__ import annotations

import tracemalloc
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.contact.scene import Scene
from contactsim.contact.simplification import simplify
from contactsim.errors import InputError, Words
from contactsim.evaluation.figure_settings import FIGURE_KEYS, FigureSettings
from contactsim.grid import Array
from contactsim.paths.driver import follow_path
from contactsim.paths.options import Setup
from contactsim.provenance import digest
from contactsim.solvers.registry import solver_module
from contactsim.status import is_solved
from contactsim.study.reading import Key, mapping, read, whole
from contactsim.study.scenes import build_setup
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.study import Study
from contactsim.study.tier_overrides import overlaid, tiered
from contactsim.traits import Trait

KEYS = FIGURE_KEYS | {
    "repeats": Key(whole(1), "how often each variant is timed, 1 or more", 1),
    "scene": Key(mapping, "keys of a study that all variants share"),
    "variants": Key(mapping, "a mapping from names to a title and the keys of a study that a variant adds"),
}
NEGLECTED = ("friction", "coupling", "second_body", "height")
"""Effects of a scene beside adhesion: it has those whose neglect changes it."""
LOAD_SHARE = 0.5
"""Load at which contact lengths are compared, over the final load of the first variant."""


@dataclass(frozen=True)
class Variant:
    """The scene with some effects: its name, its title and the settings of its run."""

    name: str
    title: str
    run: Mapping[str, Any]

    @property
    def setup(self) -> Setup:
        """Scene and options."""
        return build_setup(self.run)


@dataclass(frozen=True)
class CostJob:
    """The measurement: how often each variant is timed, and the variants."""

    repeats: int
    variants: Sequence[Variant]

    @classmethod
    def from_settings(cls, settings: Mapping[str, Any]) -> CostJob:
        """Return the job from its JSON, the settings of `effects_job`."""
        return cls(settings["repeats"], [Variant(**variant) for variant in settings["variants"]])


@dataclass(frozen=True)
class EffectCosts(FigureSettings):
    """The study of costs: how often variants are timed, the keys that they share, and the variants."""

    repeats: int
    scene: Mapping[str, Any]
    variants: Sequence[Variant]


def read_variants(folder: str | Path, seed: int, over: dict, tier: str) -> EffectCosts | None:
    """Return the study of costs of effects.yaml with a tier's changes; None without that file."""
    source = tiered(Path(folder) / "effects.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings = read(section, KEYS, file)
    variants = []
    for name, variant in settings["variants"].items():
        if not isinstance(variant, dict):
            raise InputError(f"variants.{name}", variant, "a mapping of keys of a study", file)
        try:
            study = Study.read(name, {"title": name} | overlaid(settings["scene"], variant), file, seed, [])
        except InputError as error:
            prefix = f"studies.{name}."
            own = error.key.removeprefix(prefix).partition(".")[0] in variant
            raise error.renamed(prefix, f"variants.{name}." if own else "scene.") from error
        runs = study.runs()
        if len(runs) != 1:
            raise InputError(f"variants.{name}", Words(f"{len(runs)} runs"), "one: nothing varied, one member", file)
        variants.append(Variant(name, study.settings["title"], runs[0].settings))
    return EffectCosts(**settings | {"variants": variants})


def effects_job(costs: EffectCosts) -> dict[str, Any]:
    """Return what the measurement depends on."""
    modules = sorted({solver_module(variant.run["solver"]["kind"]) for variant in costs.variants})
    job = CostJob(costs.repeats, costs.variants)
    return {"settings": asdict(job), "source": computing_stage_digest("measure_effects", *modules)}


def effects_figure_job(costs: EffectCosts, tier: str) -> dict[str, Any]:
    """Return what the figure depends on."""
    return {
        "settings": costs.layout,
        "titles": {variant.name: variant.title for variant in costs.variants},
        "repeats": costs.repeats,
        "tier": tier,
        "source": stage_digest("effects_figure"),
        "data": digest(effects_job(costs)),
    }


def measure_effects(job: CostJob) -> tuple[xr.Dataset, dict[str, dict[str, float]]]:
    """Measure all variants.

    Returns
    -------
    data : xarray.Dataset
        Effects, unknowns, transforms, steps, unconverged steps, largest pull and contact length at a load, dimension
        (variant); reproducible.
    costs : dict
        CPU seconds and peak megabytes by variant.
    """
    rows, costs, load = [], {}, 0.0
    for variant in job.variants:
        setup = variant.setup
        runs = [follow_path(setup) for _ in range(job.repeats)]
        tracemalloc.start()
        try:
            follow_path(setup)
            peak = tracemalloc.get_traced_memory()[1] / 1e6
        finally:
            tracemalloc.stop()
        data = runs[0]
        curve = _load_curve(data)
        load = load or LOAD_SHARE * curve[0][-1]
        rows.append(
            {
                "variant": variant.name,
                "components": " ".join(setup.scene.components),
                **effects_of(setup.scene),
                "unknowns": setup.points * len(setup.scene.exerted),
                "transforms": float(data.transforms.sum()),
                "unconverged": int((~is_solved(data.status)).sum()),
                "steps": data.status.size,
                "largest_pull": max(-curve[0].min(), 0.0),
                "contact_length_at_load": float(np.interp(load, *curve)),
            }
        )
        costs[variant.name] = {"seconds": min(float(run.seconds.sum()) for run in runs), "megabytes": peak}
    columns = {name: ("variant", np.array([row[name] for row in rows])) for name in rows[0] if name != "variant"}
    data = xr.Dataset(columns, {"variant": [row["variant"] for row in rows]})
    return dataset.describe(data), costs


def effects_of(scene: Scene) -> dict[str, int]:
    """Return which effects a scene has, 1 or 0."""
    neglected = {f"has_{name}": int(simplify(scene, [name]) != scene) for name in NEGLECTED}
    return {"has_adhesion": int(Trait.SMOOTH in scene.traits)} | neglected


def _load_curve(data: xr.Dataset) -> tuple[Array, Array]:
    """Return loads, N/m, and contact lengths, nm, from the largest pull on, where the load rises."""
    length = float(data.length)
    if "line_load" in data:
        loads, lengths = data.line_load.values, data.contact_length.values
    else:
        loads, lengths = data.mean_pressure.values * length, data.relative_contact_area_subgrid.values * length
    begin = int(np.argmin(loads))
    return loads[begin:], lengths[begin:]
