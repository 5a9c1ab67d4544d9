"""From a dataset to the files of a figure: PNG and PDF, the numbers behind it as CSV, the footer."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path

import pandas as pd
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactsim import aggregate, dataset
from contactsim.figures import style


def render(plan: Mapping, data_path: str, costs_path: str, targets: Mapping[str, str]) -> None:
    """Draw one figure into its files.

    plan: `Plan.figure_settings`; data_path: the study's dataset; costs_path: its costs; targets: png, pdf and csv.
    """
    data, costs, settings = dataset.read(data_path), pd.read_csv(costs_path), plan["settings"]
    for dim, (least, largest) in settings["select"].items():
        data = data.sel({dim: slice(least * (1 - 1e-9), largest * (1 + 1e-9))})
    figure = Figure(figsize=settings["size"], layout="constrained")
    FigureCanvasAgg(figure)
    figure.get_layout_engine().set(rect=(0, 0.035, 1, 0.965))
    axes = figure.subplots(1, settings["panels"], squeeze=False)[0]
    module = import_module(f"contactsim.figures.{plan['chapter']}")
    getattr(module, plan["name"])(data, axes if settings["panels"] > 1 else axes[0], settings["reference"])
    style.header(figure, settings["title"])
    style.footer(figure, footer_text(data, costs))
    _save(figure, targets["png"], {})
    _save(figure, targets["pdf"], {"metadata": {"CreationDate": None}})
    write_numbers(numbers(data), targets["csv"])


def footer_text(data: xr.Dataset, costs: pd.DataFrame) -> str:
    """Tier, grid, members, unconverged solutions, grid error, CPU time of the solutions."""
    settings = dataset.settings_of(data)
    lost, total = aggregate.left_out(data)
    parts = [
        f"{settings['tier']} tier",
        style.points_text(settings, int(data.points)),
        f"{data.member.size} member{'s' if data.member.size > 1 else ''}",
        f"{lost} of {total} solutions unconverged and left out",
    ]
    if "kappa_r_grid_error" in data:
        parts.append(f"grid error of κ_r at most {float(data.kappa_r_grid_error.max()):.1g}")
    parts.append(f"{costs.seconds.sum():.3g} s on one thread")
    return " · ".join(parts)


def numbers(data: xr.Dataset) -> pd.DataFrame:
    """Means, standard errors and grid errors of everything averaged, one row a load."""
    names = [name for name in data.data_vars if dataset.base_name(str(name))[1] and "fit" not in str(name)]
    return data[names].to_dataframe().reset_index()


def write_numbers(frame: pd.DataFrame, path: str) -> None:
    """Write a table in one move."""
    temporary = Path(path).with_name(f".{Path(path).name}.{os.getpid()}.tmp")
    frame.to_csv(temporary, index=False)
    os.replace(temporary, path)


def _save(figure: Figure, path: str, options: dict) -> None:
    temporary = Path(path).with_name(f".{os.getpid()}.{Path(path).name}")
    figure.savefig(temporary, **options)
    os.replace(temporary, path)
