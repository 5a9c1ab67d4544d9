"""Files of a figure: PNG, PDF and SVG with caption and footer, the numbers that it shows as CSV, and a film as GIF."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any

import matplotlib as mpl
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactsim.analysis.dataset_summary import sources_summary
from contactsim.analysis.ensemble import widen_interval
from contactsim.analysis.wording import printed
from contactsim.figures import film, style
from contactsim.figures.panel_table import error_texts, panel_table
from contactsim.figures.vector import write_vector
from contactsim.files import write_atomically

LINE_HEIGHT = 0.125
"""Height of a line of caption or footer, inches."""
CAPTION_LETTERS, FOOTER_LETTERS = 18.5, 22
"""Letters of caption and footer in an inch."""
CAPTION_TEXT = 7.0
"""Size of captions, points; larger in figures that are wider than print."""
PRINT_WIDTH, SMALLEST_TEXT = 7.2, 6.0
"""Width at which a figure is printed at most, inches (two columns of a journal), and its smallest text then, points."""
FOOTER = "footer"
"""Name of the footer among the texts of a figure."""


@mpl.rc_context(style.RC_PARAMS)
def write_figure(
    plan: Mapping[str, Any], data: Sequence[xr.Dataset], costs: Sequence[pd.DataFrame], targets: Mapping[str, str]
) -> None:
    """Plot one figure and write its files.

    Parameters
    ----------
    plan : what the figure depends on, of `Plan.figure_settings`
    data : the datasets that it shows, in the order of the arguments of its function
    costs : tables of costs of the same studies; none if the module of the figure has a function `footer`
    targets : paths of the files: png, pdf, svg, csv, and gif for a film
    """
    settings, module = plan["settings"], import_module(plan["module"])
    plot = getattr(module, plan["name"])
    parts = [selected(part, settings["select"]) for part in data]
    footer = sources_summary(parts, costs) if costs else module.footer(*parts)
    figure, panels = empty_figure(settings, footer, settings["rows"])
    numbers = plot(*parts, _one_or_all(panels), **settings["reference"])
    points = panel_table(figure)
    footer_text = next(text for text in figure.texts if text.get_gid() == FOOTER)
    footer_text.set_text(" · ".join([footer, *error_texts(points)]))
    tables = [table for table in (points, numbers) if len(table)]
    save(figure, pd.concat(tables, ignore_index=True), targets)
    if settings["film"] is not None:
        save_film(settings, plot, parts, targets["gif"])


def save_film(
    settings: Mapping[str, Any], plot: Callable[..., pd.DataFrame], data: Sequence[xr.Dataset], target: str
) -> None:
    """Write the film of a figure through the states of its first dataset, without caption and footer.

    settings: of the figure; plot: its function; data: the datasets that it shows
    """
    figure, panels = empty_figure({**settings, "caption": ""}, "", settings["rows"])

    def draw(frame: int) -> None:
        """Draw one state on the panels."""
        plot(*data, _one_or_all(panels), frame=frame, **settings["reference"])

    frames, speed = film.choose_frames(data[0], settings["film"]["frames"]), settings["film"]["frames_per_second"]
    write_atomically(target, lambda path: film.write_film(figure, draw, frames, speed, path))


def _one_or_all(panels: list[Axes]) -> Axes | list[Axes]:
    """Return the axes as a figure's function takes them: the only ones, or a list."""
    return panels if len(panels) > 1 else panels[0]


def selected(data: xr.Dataset, ranges: Mapping[str, tuple[float, float]]) -> xr.Dataset:
    """Return the part of a dataset inside ranges of its dimensions; dimensions that it does not have are ignored."""
    for dim, (low, high) in ranges.items():
        data = data.sel({dim: slice(*widen_interval(low, high))}) if dim in data.dims else data
    return data


def empty_figure(
    settings: Mapping[str, Any], footer: str, rows: int = 1, widths: Sequence[float] | None = None
) -> tuple[Figure, list[Axes]]:
    """Return a figure with empty panels, the title above them, caption and footer below.

    Parameters
    ----------
    settings : size (width and height of the panels, inches), panels in a row, title and caption
    footer : text below the caption
    rows : of panels
    widths : of the columns, relative to each other

    Returns
    -------
    figure, panels : the figure, higher than its panels by the text below them; the panels row by row
    """
    width, height = settings["size"]
    smallest = SMALLEST_TEXT * max(1.0, width / PRINT_WIDTH)
    size = max(CAPTION_TEXT, smallest)
    caption = textwrap.wrap(printed(settings["caption"]), int(width * CAPTION_LETTERS * CAPTION_TEXT / size))
    footer_lines = textwrap.wrap(footer, int(width * FOOTER_LETTERS * SMALLEST_TEXT / smallest))
    line = LINE_HEIGHT * size / CAPTION_TEXT
    below = (len(caption) + len(footer_lines) + 1.2) * line
    figure = Figure(figsize=(width, height + below), layout="constrained")
    share = below / (height + below)
    figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
    figure.suptitle(printed(settings["title"]), fontsize=9.5, x=0.01, ha="left")
    bottom = line * 0.4 / (height + below)
    figure.text(0.01, share - 0.3 * line / (height + below), "\n".join(caption), fontsize=size, va="top")
    look: dict[str, Any] = {"fontsize": smallest, "color": style.GREY, "va": "bottom", "gid": FOOTER}
    figure.text(0.01, bottom, "\n".join(footer_lines), **look)
    return figure, list(figure.subplots(rows, settings["panels"], squeeze=False, width_ratios=widths).flat)


def save(figure: Figure, table: pd.DataFrame, targets: Mapping[str, str]) -> None:
    """Write a figure as PNG, PDF and SVG, and the numbers that it shows as CSV."""
    write_atomically(targets["png"], figure.savefig)
    write_atomically(targets["pdf"], lambda path: figure.savefig(path, metadata={"CreationDate": None}))
    write_vector(figure, targets["svg"])
    write_atomically(targets["csv"], lambda path: table.to_csv(path, index=False))
