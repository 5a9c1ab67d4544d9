"""What runs cost: times, kept apart from results because they are not reproducible."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd

from contactsim import dataset


def table(runs: list[dict]) -> pd.DataFrame:
    """One row for each solved load: where it stands, transforms, seconds, status.

    runs: path, costs, coordinates, member and measures_error of each, as `Plan.study_settings` lists them.
    """
    return pd.concat([_of_run(run) for run in runs], ignore_index=True)


def _of_run(run: dict) -> pd.DataFrame:
    data = dataset.load_dataset(run["path"])
    spent = json.loads(Path(run["costs"]).read_text())
    load = data.status.dims[0]
    told = {"run": run["path"], **run["coordinates"], "member": run["member"], "measures_error": run["measures_error"]}
    told |= {load: data[load].values, "points": data.points.item(), "transforms": data.transforms.values}
    seconds = [spent["seconds"][str(name)] for name in data.point_digest.values]
    told |= {"seconds": seconds, "memory_mib": spent["peak_memory_of_last_run"], "status": data.status.values}
    return pd.DataFrame(told)
