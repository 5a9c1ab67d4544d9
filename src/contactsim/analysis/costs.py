"""Costs of runs: times and memory, kept apart from results because they are not reproducible."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd

from contactsim import dataset


def table(runs: list[dict]) -> pd.DataFrame:
    """Return the costs of runs, with one row for each solved load.

    Parameters
    ----------
    runs : list of dict
        Path, costs, coordinates, member and measures_error of each run, as `Plan.study_settings` lists them.

    Returns
    -------
    DataFrame
        Run, coordinates, load, grid points, transforms, seconds, memory (MiB) and status.
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
    return pd.DataFrame(columns)
