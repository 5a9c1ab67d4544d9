"""Costs of runs: times and memory, kept apart from results because they are not reproducible."""

from __future__ import annotations

import json
import time
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from contactsim import dataset
from contactsim.grid import Array, Grid
from contactsim.surfaces.statistics import rms_gradient

QUANTITIES = ("solution_seconds", "gradient_effort")
"""Costs that claims can be about: CPU seconds of a solution, and the effort of the gradient over the contact."""
REPEATS = 3
"""Repetitions of a measurement, of which the shortest counts."""


def table(runs: list[dict]) -> pd.DataFrame:
    """Return the costs of runs, with one row for each solved load.

    Parameters
    ----------
    runs : list of dict
        Path, costs, coordinates, member and measures_error of each run, as `Plan.study_settings` lists them.

    Returns
    -------
    DataFrame
        Run, coordinates, load, grid points, transforms, seconds, memory (MiB), status, and CPU seconds of both rms
        gradients, which are the same for all loads of a run and NaN where the run keeps no contact and no profile.
    """
    return pd.concat([_run_costs(run) for run in runs], ignore_index=True)


def _run_costs(run: dict) -> pd.DataFrame:
    """Return the costs of one run."""
    data = dataset.load_dataset(run["path"])
    measured = json.loads(Path(run["costs"]).read_text())
    load = data.status.dims[0]
    columns = {
        "run": run["path"],
        **run["coordinates"],
        "member": run["member"],
        "measures_error": run["measures_error"],
    }
    columns |= {load: data[load].values, "points": data.points.item(), "transforms": data.transforms.values}
    seconds = [measured["seconds"][str(name)] for name in data.point_digest.values]
    columns |= {"seconds": seconds, "memory_mib": measured["peak_memory_of_last_run"], "status": data.status.values}
    whole, contact = (np.nan, np.nan) if run["measures_error"] else gradient_seconds(data)
    return pd.DataFrame(columns | {"gradient_seconds": whole, "contact_gradient_seconds": contact})


def gradient_seconds(data: xr.Dataset) -> tuple[float, float]:
    """Return the CPU seconds of the rms gradient of Eq. 3.8 over the whole surface and over the contact.

    data: of a run; NaN if it does not keep its contact and its profile. The contact is that of the last load.
    """
    if not {"contact_bits", "profile_real"} <= set(data):
        return float("nan"), float("nan")
    heights, spacing = heights_of_run(data)
    bits = data.contact_bits.values[-1]
    contact = np.unpackbits(bits, count=heights.size).astype(bool).reshape(heights.shape)
    return _least_seconds(heights, spacing, None), _least_seconds(heights, spacing, contact)


def heights_of_run(data: xr.Dataset) -> tuple[Array, tuple[float, ...]]:
    """Return the heights of a run that keeps its profile, nm, and the spacing in each direction, nm."""
    shape, lengths = [data.points.item()], [data.length.item()]
    if "points_y" in data:
        shape, lengths = [data.points_y.item(), *shape], [data.length_y.item(), *lengths]
    grid = Grid(tuple(shape), tuple(lengths))
    waves = data.profile_real.values + 1j * data.profile_imag.values
    if waves.shape == grid.half_shape:
        return grid.backward(waves), grid.spacing
    half = np.zeros(grid.half_shape, complex)
    half[grid.low_modes(waves.shape[-1] - 1)] = waves
    return grid.backward(half), grid.spacing


def _least_seconds(heights: Array, spacing: tuple[float, ...], where: Array | None) -> float:
    """Return the shortest CPU time of an rms gradient."""
    seconds = []
    for _ in range(REPEATS):
        begin = time.process_time()
        rms_gradient(heights, spacing, where)
        seconds.append(time.process_time() - begin)
    return min(seconds)


def read_costs(path: str | Path) -> pd.DataFrame:
    """Return a table of costs from its file."""
    return pd.read_csv(path)


def with_costs(data: xr.Dataset, costs: pd.DataFrame) -> xr.Dataset:
    """Return the dataset of a study with the costs that claims can be about, of `QUANTITIES`.

    `solution_seconds` is the CPU time of each solution, `gradient_effort` how much longer the rms gradient over the
    contact takes than that over the whole surface, over the mean time of a solution of its run.
    """
    dims = [str(dim) for dim in data.status.dims]
    load = dims[-1]
    rows = costs[~costs.measures_error.astype(bool)].set_index(dims).sort_index()
    names = ["seconds", "gradient_seconds", "contact_gradient_seconds"]
    numbers = rows[names].to_xarray().reindex({dim: data[dim] for dim in dims}, method="nearest")
    extra = (numbers.contact_gradient_seconds - numbers.gradient_seconds).isel({load: -1}, drop=True)
    return data.assign(solution_seconds=numbers.seconds, gradient_effort=extra / numbers.seconds.mean(load))
