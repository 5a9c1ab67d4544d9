"""The results of a case that the figure of accuracy versus cost shows: measured here, or kept in the package."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import xarray as xr

from contactsim import dataset
from contactsim.evaluation.work_precision.baselines import load_baseline
from contactsim.evaluation.work_precision.cases import REFERENCE


@dataclass(frozen=True)
class CaseResults:
    """Results of a case, in the order of its jobs.

    Parameters
    ----------
    data : datasets by job
    seconds : seconds of each setting by solver, all as on the machine that measured the study's own
    transform_seconds : time of a transform on that machine
    """

    data: Mapping[str, xr.Dataset]
    seconds: Mapping[str, Sequence[float]]
    transform_seconds: float


def read_results(plan: Mapping[str, Any], files: Mapping[str, Any]) -> CaseResults:
    """Return the results of a case.

    Parameters
    ----------
    plan : of `contactsim.evaluation.work_precision.case_config.case_figure_job`
    files : data and costs, of the jobs that are not kept; baselines, the package's tables, that of all jobs first
    """
    measured = [job for job in plan["jobs"] if job not in plan["kept"]]
    data = {job: dataset.load_dataset(file) for job, file in zip(measured, files["data"], strict=True)}
    costs = {job: json.loads(Path(file).read_text()) for job, file in zip(measured, files["costs"], strict=True)}
    seconds = {job: cost["seconds"] for job, cost in costs.items()}
    transform_seconds = costs[plan["default"]]["transform_seconds"]
    for solver in plan["kept"]:
        baseline = load_baseline(plan["case"], solver, Path(files["baselines"][0]))
        data[solver], seconds[solver] = baseline.data, baseline.scaled_seconds(transform_seconds)
    return CaseResults(
        data={job: data[job] for job in plan["jobs"]},
        seconds={job: seconds[job] for job in plan["jobs"] if job != REFERENCE},
        transform_seconds=transform_seconds,
    )
