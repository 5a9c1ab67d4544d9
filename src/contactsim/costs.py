"""What runs cost: times, kept apart from results because they are not reproducible."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd

from contactsim import dataset


def table(runs: list[dict]) -> pd.DataFrame:
    """One row for each solved load: where it stands, transforms, seconds, status.

    runs: path, costs, coordinates, member and companion of each, as `Plan.study_settings` lists them.
    """
    rows = []
    for run in runs:
        data = dataset.read(run["path"])
        spent = json.loads(Path(run["costs"]).read_text())
        load = data.status.dims[0]
        for row in range(data.status.size):
            here = data.isel({load: row})
            rows.append(
                {"run": run["path"], **run["coordinates"], "member": run["member"], "companion": run["companion"]}
                | {load: here[load].item(), "points": here.points.item(), "transforms": here.transforms.item()}
                | {
                    "seconds": spent["seconds"][str(here.point.item())],
                    "memory_mib": spent["peak_memory_of_last_run"],
                    "status": here.status.item(),
                }
            )
    return pd.DataFrame(rows)
