"""Compute a run of a study, as its settings are, into its files."""

from __future__ import annotations

import json
import logging
import resource
import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.files import write_text
from contactsim.paths.driver import follow_path, path_driver
from contactsim.paths.options import Setup
from contactsim.paths.reuse import Point, Reuse
from contactsim.provenance import digest
from contactsim.status import warn_of_excess
from contactsim.study.scenes import build_setup, settings_of_single_loads

logger = logging.getLogger(__name__)


@dataclass(frozen=True)
class RunFiles:
    """Files of a run.

    Parameters
    ----------
    data, costs : path
        Its dataset, and the file of its costs.
    alike : tuple of RunFiles
        Files of runs that differ in their loads alone. What they hold already is not solved again.
    """

    data: str | Path
    costs: str | Path
    alike: tuple[RunFiles, ...] = ()


def run(settings: dict, source: str, files: RunFiles, threads: int = 1) -> None:
    """Compute a run as its settings are, into its dataset and costs.

    Parameters
    ----------
    settings : dict
        Settings of a `contactsim.study.run.Run`.
    source : str
        Digest of the code that computes it.
    files : RunFiles
        Files to write; loads that the same code solved before are taken over from earlier datasets.
    threads : int
        Threads of the transforms.
    """
    begin = time.process_time()
    data, settings = compute(build_setup(settings, threads), settings, source, files)
    keep_run(data, settings, source, files, begin)


def compute(setup: Setup, settings: dict, source: str, files: RunFiles) -> tuple[xr.Dataset, dict]:
    """Return the dataset of a run as it is; single loads that earlier datasets hold are not solved again."""
    driver = path_driver(setup.scene.kind)
    solved: dict[str, Point] = {}
    for earlier in (*files.alike, files):
        solved |= driver.read_points(earlier.data, earlier.costs)
    names = point_digests(settings, source, len(setup.scene.path.steps))
    points = {step: solved[name] for step, name in enumerate(names) if name in solved}
    data = follow_path(setup, Reuse(points=points or None))
    warn_of_excess(data)
    return data, settings


def keep_run(data: xr.Dataset, settings: dict, source: str, files: RunFiles, begin: float) -> None:
    """Write the dataset of a run and, apart from it, its costs; begin: CPU time at which it began."""
    names = point_digests(settings, source, data.step.size)
    seconds = data.seconds.values.tolist()
    title = f"contactsim run of {settings['study']}"
    dataset.write(dataset.stamp(label_run(data, settings, names), title, settings, source), files.data)
    spent = {
        "seconds": dict(zip(names, seconds, strict=True)),
        "cpu_seconds_of_last_run": time.process_time() - begin,
        "peak_memory_of_last_run": peak_memory(),
    }
    write_text(json.dumps(spent, indent=1), files.costs)


def point_digests(settings: dict, source: str, steps: int) -> list[str]:
    """Return a digest of the code and settings that make each point of a run.

    Single loads do not depend on the others; a state of a path depends on all of it.
    """
    shared = settings_of_single_loads(settings) or settings
    return [digest(shared, place, source) for place in _places(settings, steps)]


def _places(settings: dict, steps: int) -> list:
    """Return the coordinate of each step: its load or, as a path may come to a value twice, its number."""
    load = settings["load"]
    return load["values"] if "values" in load else list(range(steps))


def label_run(data: xr.Dataset, settings: dict, names: list[str]) -> xr.Dataset:
    """Return a simulation as a run stores it: steps by the study's own load, the name of each point, no times."""
    load, values = settings["load"]["name"], _places(settings, data.step.size)
    data = data.drop_vars(["seconds", load], errors="ignore").rename(step=load).assign_coords({load: values})
    return dataset.describe(data.assign(seed=settings["seed"], point_digest=(load, np.array(names, object))))


def peak_memory() -> float:
    """Return the largest resident memory of this process so far (MiB)."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (2**20 if sys.platform == "darwin" else 2**10)
