"""From a dataset to the files of a figure: PNG and PDF with caption and footer, and the numbers behind it as CSV."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.animation import PillowWriter
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from contactsim import dataset, status, variables
from contactsim.analysis import ensemble
from contactsim.figures import style
from contactsim.files import write_atomically
from contactsim.notation import READ, SYMBOLS
from contactsim.study.law_table import tabulated

LINE_INCHES = 0.125
"""Height of a line of caption or footer."""
FILM_DPI, CLOSE = 110, 1e-6
"""Of a film's frames; of a slide, nm: what is nearer counts as the same."""
PRICED = {name: READ[name] for name in ("kappa", "kappa_r", "kappa_r_pairs")} | {
    "final_contact_length": "contact",
    "pull_off_load_loading": "pull-off on loading",
    "pull_off_load_unloading": "on unloading",
}
"""Quantities whose errors a footer tells, and how."""
PRICED_SLIDES = {name: SYMBOLS[name] for name in ("static_friction", "first_force_drop", "reattached_fraction")}
"""The same of slides."""


def render(plan: Mapping, data: Sequence[str], costs: Sequence[str], targets: Mapping[str, str]) -> None:
    """Draw one figure into its files.

    plan: `Plan.figure_settings`; data: paths of the datasets; costs: of the studies' costs, none where the module of
    the figure writes a `footer` of its own; targets: png, pdf and csv, and gif where there is a film.
    """
    settings, shown_data = plan["settings"], [dataset.load_dataset(path) for path in data]
    if settings["law"] is not None:
        shown_data = [tabulated(settings["law"])]
    module = import_module(plan["module"])
    draw = getattr(module, plan["name"])
    for dim, ends in settings["select"].items():
        part = {dim: slice(*ensemble.widen_interval(*ends))}
        shown_data = [one.sel(part) if dim in one.dims else one for one in shown_data]
    priced = [footer_text(one, pd.read_csv(path)) for one, path in zip(shown_data, costs, strict=bool(costs))]
    figure, panels = framed(settings, " — ".join(priced) if priced else module.footer(*shown_data))
    panels = panels if len(panels) > 1 else panels[0]
    shown = draw(*shown_data, panels, **settings["reference"])
    save(figure, shown, targets)
    if settings["film"] is not None:
        write_atomically(targets["gif"], lambda path: film(figure, panels, draw, shown_data[0], settings["film"], path))


def film(
    figure: Figure, panels: list[Axes] | Axes, draw: Callable, data: xr.Dataset, frames_per_second: float, path: Path
) -> None:
    """The figure drawn again for each snapshot of a slide, of the states up to it, within the axes of the whole."""
    FigureCanvasAgg(figure).draw()
    figure.set_layout_engine("none")
    every = np.atleast_1d(panels)
    ends = [(panel.get_xlim(), panel.get_ylim()) for panel in every]
    writer = PillowWriter(fps=frames_per_second)
    with writer.saving(figure, str(path), dpi=FILM_DPI):
        for count, value in enumerate(data.snapshot.values):
            reached = ~(data.sliding_distance.isel(member=0) > value + CLOSE)
            for panel in every:
                panel.clear()
            draw(data.isel(snapshot=slice(count + 1), step=np.flatnonzero(reached)), panels)
            for panel, (across, up) in zip(every, ends, strict=True):
                panel.set(xlim=across, ylim=up)
            writer.grab_frame()


def framed(settings: Mapping, footer: str, rows: int = 1, widths: Sequence[float] | None = None) -> tuple[Figure, list]:
    """An empty figure with its panels, row by row, the title above, caption and footer below them.

    settings: of a figure, with size, panels a row, title and caption; widths: of the columns, relative to each other.
    The text below adds to the height.
    """
    width, height = settings["size"]
    caption = textwrap.wrap(settings["caption"], int(width * 18.5))
    made = textwrap.wrap(footer, int(width * 22))
    below = (len(caption) + len(made) + 1.2) * LINE_INCHES
    figure = Figure(figsize=(width, height + below), layout="constrained")
    share = below / (height + below)
    figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
    figure.suptitle(settings["title"], fontsize=9.5, x=0.01, ha="left")
    bottom = LINE_INCHES * 0.4 / (height + below)
    figure.text(0.01, share - 0.3 * LINE_INCHES / (height + below), "\n".join(caption), fontsize=7, va="top")
    figure.text(0.01, bottom, "\n".join(made), fontsize=6, color="#777777", va="bottom")
    return figure, list(figure.subplots(rows, settings["panels"], squeeze=False, width_ratios=widths).flat)


def footer_text(data: xr.Dataset, costs: pd.DataFrame) -> str:
    """Tier, grid, members, and of the loads shown unconverged solutions and largest errors; the study's time."""
    settings = dataset.settings_of(data)
    lost, total = ensemble.unconverged(data)
    members = data.member.size
    parts = [
        f"{settings['tier']} tier, {settings['name'].replace('_', ' ')}",
        style.points_text(settings, *data.points.values.ravel()),
        f"{members} members" if members > 1 else "1 member",
        f"{lost} of {total} solutions unconverged and left out",
    ]
    if "validity_flags" in data and (far := status.told(data)):
        parts.append(f"beyond the model: {', '.join(far)} of the states")
    parts += errors_told(data)
    return " · ".join([*parts, f"study solved in {costs.seconds.sum():.3g} CPU s"])


def errors_told(data: xr.Dataset) -> list[str]:
    """The largest errors of the quantities that are told, a line a kind of error."""
    priced, told = PRICED_SLIDES if "static_friction" in data else PRICED, []
    for error in variables.ERRORS:
        sizes = [
            f"{words} {float(data[f'{name}_{error}_error'].max()):.1g}{_unit(data[name])}"
            for name, words in priced.items()
            if f"{name}_{error}_error" in data and not np.isnan(data[f"{name}_{error}_error"]).all()
        ]
        if sizes:
            told.append(f"{error.replace('_', ' ')} error up to: {', '.join(sizes)}")
    return told


def _unit(values: xr.DataArray) -> str:
    unit = values.attrs.get("units", "1")
    return "" if unit == "1" else f" {unit}"


def save(figure: Figure, shown: pd.DataFrame, targets: Mapping[str, str]) -> None:
    """Save a figure as PNG and PDF, and the numbers that it shows as CSV."""
    write_atomically(targets["png"], figure.savefig)
    write_atomically(targets["pdf"], lambda path: figure.savefig(path, metadata={"CreationDate": None}))
    write_atomically(targets["csv"], lambda path: shown.to_csv(path, index=False))
