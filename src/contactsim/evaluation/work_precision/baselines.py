"""Results of baselines, the solvers that are compared with a study's own, as the package contains them.

One table lists the jobs: a digest of their settings, the date, and the time of a transform on the machine that measured
them. A further table for each case holds the solutions of all settings, one row each.
"""

from __future__ import annotations

import contextlib
import datetime
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from contactsim import dataset
from contactsim.evaluation.work_precision.cases import Case
from contactsim.evaluation.work_precision.knobs import KNOBS
from contactsim.files import write_text
from contactsim.provenance import digest

FILE = Path(__file__).with_name("baselines.csv")
"""The jobs whose results the package contains, measured by `snakemake export_baselines`."""
JOB_COLUMNS = ("case", "solver", "settings", "measured", "transform_seconds")
"""Columns of the table of jobs; `settings` is the digest of what `Case.job_settings` returns."""
SETTING_COLUMNS = ("knob", *KNOBS, "points_y", "seconds")
"""Columns that have one value for each setting; they stand behind the dimensions."""


@dataclass(frozen=True)
class Baseline:
    """Results of one solver in one case.

    Parameters
    ----------
    case, solver
        Their names.
    settings
        Digest of the settings of the job.
    measured
        Date of the measurement, as 2000-12-31.
    transform_seconds
        Seconds of a transform on the machine that measured.
    seconds
        Seconds of each setting there.
    data
        Solutions, as `Case.measure` returns them.
    """

    case: str
    solver: str
    settings: str
    measured: str
    transform_seconds: float
    seconds: Sequence[float]
    data: xr.Dataset

    @classmethod
    def from_files(cls, data: str | Path, costs: str | Path) -> Baseline:
        """Return the results of a job from its two files; the date is that of the costs."""
        solutions = dataset.load_dataset(data)
        settings = dataset.settings_of(solutions)
        measured = datetime.date.fromtimestamp(Path(costs).stat().st_mtime).isoformat()
        cost = json.loads(Path(costs).read_text(encoding="utf-8"))
        job = settings["case"], settings["job"], digest(settings)
        return cls(*job, measured, cost["transform_seconds"], cost["seconds"], solutions.drop_attrs())

    def scaled_seconds(self, transform_seconds: float) -> list[float]:
        """Return the seconds of each setting on a machine with another time of a transform."""
        return [seconds * transform_seconds / self.transform_seconds for seconds in self.seconds]


def table_file(case: str, jobs: Path = FILE) -> Path:
    """Return the file with the solutions of a case, which lies beside the table of jobs."""
    return jobs.with_name("baseline_tables") / f"{case}.csv"


def measured_dates(case: Case, jobs: Path = FILE) -> dict[str, str]:
    """Return the date of the kept results by solver, for baselines whose settings are those of the table of jobs."""
    rows = {row["solver"]: row for row in _read_jobs(jobs) if row["case"] == case.name}
    return {
        solver: rows[solver]["measured"]
        for solver in case.baselines
        if solver in rows and rows[solver]["settings"] == digest(case.job_settings(solver))
    }


def load_baseline(case: str, solver: str, jobs: Path = FILE) -> Baseline:
    """Return the kept results of a solver; KeyError where there are none."""
    rows = {(row["case"], row["solver"]): row for row in _read_jobs(jobs)}
    row = rows[case, solver]
    table = pd.read_csv(table_file(case, jobs), dtype=str, keep_default_na=False)
    data = _dataset_of(table[table.solver == solver].drop(columns="solver"))
    seconds, transform_seconds = data.seconds.values.tolist(), float(row["transform_seconds"])
    solutions = data.drop_vars("seconds")
    return Baseline(case, solver, row["settings"], row["measured"], transform_seconds, seconds, solutions)


def write_baselines(baselines: Sequence[Baseline], jobs: Path) -> None:
    """Write the table of jobs, and beside it the table of each case."""
    rows = [[getattr(baseline, name) for name in JOB_COLUMNS] for baseline in baselines]
    for case in dict.fromkeys(baseline.case for baseline in baselines):
        tables = [_table_of(baseline) for baseline in baselines if baseline.case == case]
        write_text(pd.concat(tables).to_csv(index=False, na_rep="nan", lineterminator="\n"), table_file(case, jobs))
    write_text(pd.DataFrame(rows, columns=JOB_COLUMNS).to_csv(index=False, lineterminator="\n"), jobs)


def _read_jobs(jobs: Path) -> list[dict[str, str]]:
    """Return the rows of the table of jobs, every entry as text: a digest may look like a number."""
    return pd.read_csv(jobs, dtype=str)[list(JOB_COLUMNS)].to_dict("records")


def _table_of(baseline: Baseline) -> pd.DataFrame:
    """Return one row a solution: the solver, its place in each dimension, its setting and its results."""
    data = baseline.data.assign(seconds=("setting", list(baseline.seconds)))
    dims = ["setting", *(dim for dim in data.transforms.dims if dim != "setting")]
    settings = [name for name in SETTING_COLUMNS if name in data]
    table = data.to_dataframe(dim_order=dims).reset_index()
    results = [name for name in table if name not in {*dims, *settings}]
    return table.assign(solver=baseline.solver)[["solver", *dims, *settings, *results]]


def _dataset_of(table: pd.DataFrame) -> xr.Dataset:
    """Return the dataset of the rows of one solver, read as text."""
    dims = list(table)[: list(table).index("knob")]
    shape = [table[dim].nunique() for dim in dims]
    variables: dict[str, tuple[object, np.ndarray]] = {}
    for name in list(table)[len(dims) :]:
        values = _values(table[name]).reshape(shape)
        per_setting = values.reshape(shape[0], -1)[:, 0]
        variables[name] = ("setting", per_setting) if name in SETTING_COLUMNS else (dims, values)
    variables["status"] = (dims, variables["status"][1].astype(np.int8))
    return xr.Dataset(variables, {dim: _values(table[dim].unique()) for dim in dims[1:]})


def _values(texts: Iterable[str]) -> np.ndarray:
    """Return whole numbers, other numbers or words, whichever the texts are; numbers to the last digit."""
    words = list(texts)
    for kind in (int, float):
        with contextlib.suppress(ValueError):
            return np.array([kind(word) for word in words])
    return np.array(words)
