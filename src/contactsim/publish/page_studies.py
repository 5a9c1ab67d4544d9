"""Studies on the page of a report: cost, settings, files, and a sketch of the scene."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
import xarray as xr

from contactsim import dataset
from contactsim.analysis.dataset_summary import dataset_summary
from contactsim.durations import duration_text
from contactsim.publish.page_pictures import Picture, sketch_picture
from contactsim.study.plan import Plan

HIDDEN_SETTINGS = ("name", "title", "tier", "seed")
"""Settings that stand elsewhere on the page."""


@dataclass(frozen=True)
class PageStudy:
    """A study of the page: title, summary of its dataset, cost, settings, a sketch of its scene, and its files."""

    title: str
    summary: str
    cost: str
    settings: dict[str, str]
    sketch: Picture
    dataset: str
    costs: str


def page_study(plan: Plan, folder: Path, name: str) -> PageStudy:
    """Return the part of the page about a study."""
    files = f"datasets/{plan.dataset_name(name)}.nc", f"costs/{plan.dataset_name(name)}.csv"
    data, costs = dataset.load_dataset(folder / files[0]), pd.read_csv(folder / files[1])
    sketch = sketch_picture(plan.studies[name].runs()[0].settings)
    return PageStudy(data.attrs["title"], dataset_summary(data, costs), _cost(costs), _settings(data), sketch, *files)


def _cost(costs: pd.DataFrame) -> str:
    """Return the cost of a study in words."""
    runs, transforms, memory = costs.run.nunique(), costs.transforms.sum(), costs.memory_mib.max()
    time = duration_text(costs.seconds.sum())
    return f"{runs} runs, {transforms:.3g} transforms, {time} of CPU time, at most {memory:.0f} MiB"


def _settings(data: xr.Dataset) -> dict[str, str]:
    """Return the settings of a dataset as text, without empty ones; long lists of loads are shortened."""
    settings = dataset.settings_of(data)
    if len(settings["load"]["values"]) > 20:
        values = settings["load"]["values"]
        settings["load"] |= {"values": f"{len(values)} from {values[0]:g} to {values[-1]:g}"}
    shown_settings = {
        key: value for key, value in settings.items() if key not in HIDDEN_SETTINGS and value not in (None, {}, [])
    }
    return {
        key: json.dumps(value, ensure_ascii=False).replace('"', "") for key, value in sorted(shown_settings.items())
    }
