"""Compute a run of a study into its files."""

from __future__ import annotations

import json
import logging
import resource
import sys
import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.files import write_text
from contactsim.paths.pressures import earlier
from contactsim.paths.record import options
from contactsim.provenance import digest
from contactsim.simulation import simulate
from contactsim.solvers.registry import make_solver
from contactsim.study.scenes import points_of, scene_of

logger = logging.getLogger(__name__)


Files = tuple[str | Path, str | Path]
"""A run's dataset, and the file of its costs."""


def run(
    settings: dict,
    source: str,
    target: str | Path,
    costs: str | Path,
    threads: int = 1,
    told: Mapping[str, object] | None = None,
) -> None:
    """Compute a run's dataset and costs, taking over what an earlier dataset of that name already holds.

    settings: of a `contactsim.study.study.Run`; source: digest of the code that computes it; told: what the dataset
    says
    besides.
    """
    begin = time.process_time()
    scene = scene_of(settings)
    names = names_of(settings, source)
    solved = {} if "increments" in settings else earlier(target, costs)
    data = simulate(
        scene,
        points=points_of(settings, scene.upper.surface),
        tolerance=settings["tolerance"],
        method=make_solver(**settings["solver"]),
        threads=threads,
        known={step: solved[name] for step, name in enumerate(names) if name in solved} or None,
        **asked_of(settings),
    )
    keep(data.assign(told or {}), settings, names, source, (target, costs), begin)


def keep(data: xr.Dataset, settings: dict, names: list[str], source: str, files: Files, begin: float) -> None:
    """Write a run's dataset and, apart from it, its costs; names: of its points; begin: CPU time at which it began."""
    target, costs = files
    seconds = data.seconds.values.tolist()
    title = f"contactsim run of {settings['study']}"
    dataset.write(dataset.stamped(labelled(data, settings, names), title, settings, source), target)
    price = {
        "seconds": dict(zip(names, seconds, strict=True)),
        "cpu_seconds_of_last_run": time.process_time() - begin,
        "peak_memory_of_last_run": peak_memory(),
    }
    write_text(json.dumps(price, indent=1), costs)


def names_of(settings: dict, source: str) -> list[str]:
    """Digests of the code and settings that make each point of a run."""
    return [digest(_alone(settings), place, source) for place in _places(settings)]


def _places(settings: dict) -> list:
    """Where a run's steps stand along its load; those of a path by their number, as it may come to a value twice."""
    load = settings["load"]
    return load["values"] if "values" in load else list(range(len(scene_of(settings).path.steps)))


def _alone(settings: dict) -> dict:
    """Settings of one point: loads solved on their own do not depend on the others, a path does."""
    return settings | {"load": settings["load"]["name"]} if "values" in settings["load"] else settings


def asked_of(settings: dict) -> dict:
    """What a run's simulation is asked for, beside its grid and tolerance: fields to keep, or how a path is walked."""
    return options(settings) if "increments" in settings else {"keep": settings["keep"]}


def peak_memory() -> float:
    """Largest resident memory of this process so far (MiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)


def labelled(data: xr.Dataset, settings: dict, names: list[str]) -> xr.Dataset:
    """A simulation as a run stores it: steps by the study's own load, the name of each point, no times."""
    load, values = settings["load"]["name"], _places(settings)
    data = data.drop_vars(["seconds", load], errors="ignore").rename(step=load).assign_coords({load: values})
    return dataset.described(data.assign(seed=settings["seed"], point_digest=(load, np.array(names, object))))
