"""Measure the cost of effects: one scene with more and more of them, each variant alone.

Unknowns, transforms and the status of every step are reproducible; seconds and memory are kept apart.
"""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.errors import InputError
from contactsim.paths.driver import follow_path
from contactsim.provenance import digest
from contactsim.solvers.registry import solver_module
from contactsim.status import is_solved
from contactsim.study.reading import Key, mapping, overlaid, read, size, text, tiered, whole
from contactsim.study.scenes import build_setup
from contactsim.study.stages import computing_stage_digest, stage_digest
from contactsim.study.study import Study

KEYS = {
    "title": Key(text, "a line of text"),
    "caption": Key(text, "text"),
    "size": Key(size, "width and height in inches"),
    "repeats": Key(whole(1), "how often each variant is timed, 1 or more", 1),
    "scene": Key(mapping, "keys of a study that all variants share"),
    "variants": Key(mapping, "a mapping from names to a title and the keys of a study that a variant adds"),
}


def read_variants(folder: str | Path, seed: int, over: dict, tier: str) -> dict | None:
    """Return the settings of the study of costs, with name, title and run of each variant; None without the file."""
    source = tiered(Path(folder) / "effects.yaml", over, tier)
    if source is None:
        return None
    section, file = source
    settings = read(section, KEYS, file)
    variants = []
    for name, variant in settings["variants"].items():
        if not isinstance(variant, dict):
            raise InputError(f"variants.{name}", variant, "a mapping of keys of a study", file)
        study = Study.read(name, {"title": name} | overlaid(settings["scene"], variant), file, seed)
        runs = study.runs()
        if len(runs) != 1:
            raise InputError(f"variants.{name}", f"{len(runs)} runs", "one: nothing varied, one member", file)
        variants.append({"name": name, "title": study.settings["title"], "run": runs[0].settings})
    return settings | {"variants": variants}


def effects_job(settings: dict) -> dict:
    """Return what the measurement depends on."""
    modules = sorted({solver_module(variant["run"]["solver"]["kind"]) for variant in settings["variants"]})
    job = {key: settings[key] for key in ("repeats", "variants")}
    return {"settings": job, "source": computing_stage_digest("measure_effects", *modules)}


def effects_figure_job(settings: dict, tier: str) -> dict:
    """Return what the figure depends on."""
    titles = {variant["name"]: variant["title"] for variant in settings["variants"]}
    figure = {key: settings[key] for key in ("title", "caption", "size")}
    code, data = stage_digest("effects_figure"), digest(effects_job(settings))
    settings = {"settings": figure, "titles": titles, "repeats": settings["repeats"], "tier": tier}
    return settings | {"source": code, "data": data}


def measure_effects(settings: dict) -> tuple[xr.Dataset, dict]:
    """Measure all variants.

    Returns
    -------
    data : xarray.Dataset
        Unknowns, transforms, steps and unconverged steps, dimension (variant); reproducible.
    costs : dict
        CPU seconds and peak megabytes by variant.
    """
    rows, spent = [], {}
    for variant in settings["variants"]:
        name = variant["name"]
        setup = build_setup(variant["run"])
        runs = [follow_path(setup) for _ in range(settings["repeats"])]
        tracemalloc.start()
        try:
            follow_path(setup)
            peak = tracemalloc.get_traced_memory()[1] / 1e6
        finally:
            tracemalloc.stop()
        data = runs[0]
        rows.append(
            {
                "variant": name,
                "components": " ".join(setup.scene.components),
                "unknowns": setup.points * len(setup.scene.exerted),
                "transforms": float(data.transforms.sum()),
                "unconverged": int((~is_solved(data.status)).sum()),
                "steps": data.status.size,
            }
        )
        spent[name] = {"seconds": min(float(run.seconds.sum()) for run in runs), "megabytes": peak}
    columns = {name: ("variant", np.array([row[name] for row in rows])) for name in rows[0] if name != "variant"}
    data = xr.Dataset(columns, {"variant": [row["variant"] for row in rows]})
    return dataset.describe(data), spent
