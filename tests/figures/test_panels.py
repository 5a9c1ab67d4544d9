"""Each panel of a figure can be plotted again from its table, curves have names, and all text is legible in print."""

from __future__ import annotations

import os
from functools import cache

import numpy as np
import pandas as pd
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

from contactsim import dataset
from contactsim.figures import layout, style
from contactsim.figures.drawn import COLOUR_BAR
from contactsim.figures.panel_table import COLUMNS, error_texts, panel_table
from contactsim.study.law_table import tabulate_law
from contactsim.study.plan import Plan
from support.places import ROOT

CAPS = ("_", "|")
"""Markers of the caps of error bars."""
PLAN = Plan.read(ROOT / "config", "quick")


@cache
def figure_and_table(made, name):
    """A figure as the workflow draws it, and its table of what is drawn."""
    figure, law = PLAN.figures[name], PLAN.figures[name].settings["law"]
    results = made / "results/quick"
    names = [PLAN.dataset_name(study) for study in figure.studies]
    data = [dataset.load_dataset(results / f"datasets/{study}.nc") for study in names]
    costs = [pd.read_csv(results / f"costs/{study}.csv") for study in names]
    plan = PLAN.figure_settings(name) | {"settings": PLAN.figure_settings(name)["settings"] | {"film": None}}
    saved = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(layout, "save", lambda *arguments: saved.extend(arguments))
        layout.write_figure(plan, [tabulate_law(law)] if law else data, costs, {"csv": os.devnull})
    drawn, table, _ = saved
    drawn.draw_without_rendering()
    return drawn, table[table.point.notna()] if "point" in table else pd.DataFrame(columns=COLUMNS)


def panels(figure):
    """The axes of each panel, by its letter."""
    letters: dict[object, str] = {}
    for axes in figure.axes:
        if axes.get_label() != COLOUR_BAR:
            letter = letters.setdefault(axes.get_subplotspec(), "abcdefgh"[len(letters)])
            yield letter, axes


def has_points(rows, columns, points):
    """True if rows hold all finite points, in their columns."""
    points = np.asarray(points, float)
    points = points[np.isfinite(points).all(axis=1)]
    have = set(map(tuple, rows[columns].to_numpy(float)))
    return set(map(tuple, points)) <= have


@pytest.mark.parametrize("name", PLAN.figures)
def test_every_panel_can_be_plotted_again_from_its_table(made, name):
    figure, table = figure_and_table(made, name)
    for letter, axes in panels(figure):
        rows = table[table.panel == letter]
        lines = [line for line in axes.lines if np.size(line.get_xdata()) and line.get_marker() not in CAPS]
        for line in lines:
            if line.get_transform() == axes.transData:
                assert has_points(rows, ["x", "y"], line.get_xydata()), (letter, line)
        for bars in axes.collections:
            if isinstance(bars, LineCollection):
                segments = [np.asarray(segment) for segment in bars.get_segments() if len(segment)]
                upright = [segment[:, 1] for segment in segments if segment[0, 0] == segment[1, 0]]
                level = [segment[:, 0] for segment in segments if segment[0, 0] != segment[1, 0]]
                assert not upright or has_points(rows, ["y_low", "y_high"], upright), letter
                assert not level or has_points(rows, ["x_low", "x_high"], level), letter
        if axes.axison and (lines or axes.images):
            shown = rows[rows.y_label == rows.y_label] if len(rows) else rows
            assert axes.get_xscale() in set(shown.x_scale)
            assert axes.get_yscale() in set(shown.y_scale)


@pytest.mark.parametrize("name", PLAN.figures)
def test_every_curve_of_a_panel_has_a_name_of_its_own(made, name):
    _, table = figure_and_table(made, name)
    if len(table):
        curves = table.assign(number=table.point.str.split("-").str[0])[["panel", "number", "curve"]].drop_duplicates()
        assert (curves.curve != "").all(), curves[curves.curve == ""]
        assert not curves.duplicated(["panel", "curve"]).any(), curves[curves.duplicated(["panel", "curve"])]


@pytest.mark.parametrize("name", PLAN.figures)
def test_no_text_is_smaller_than_six_points_in_print_and_the_footer_is_one_line(made, name):
    figure, _ = figure_and_table(made, name)
    scale = min(1.0, layout.PRINT_WIDTH / figure.get_figwidth())
    for text in figure.findobj(Text):
        if text.get_visible() and text.get_text():
            assert text.get_fontsize() * scale >= layout.SMALLEST_TEXT - 1e-9, text.get_text()
    (footer,) = (text for text in figure.texts if text.get_gid() == layout.FOOTER)
    assert "\n" not in footer.get_text()
    assert footer.get_window_extent().x1 <= figure.bbox.x1, footer.get_text()


def test_a_table_has_values_errors_names_and_scales_of_a_curve():
    figure = Figure()
    axes = figure.subplots()
    axes.set(xscale="log", xlabel="$x$", ylabel=r"$\kappa$")
    style.errorbars(axes, [1, 10], [2.0, 4.0], [0.1, np.nan], label="curve")
    axes.axhline(3.0, label="_exact")
    table = panel_table(figure)
    assert list(table) == COLUMNS
    assert list(table.point) == ["a1-1", "a1-2", "a2-1"]
    assert list(table.curve) == ["curve", "curve", "exact"]
    assert np.allclose(table[["y_low", "y_high"]].iloc[0], [1.9, 2.1])
    assert np.allclose(table.relative_error, [0.05, np.nan, np.nan], equal_nan=True)
    assert np.isnan(table.x.iloc[2])
    assert table.y.iloc[2] == 3.0
    assert set(table.x_scale) == {"log"}
    assert set(table.y_scale) == {"linear"}
    assert error_texts(table) == ["median error bar 5 %"]


def test_a_band_has_its_edges_as_errors_and_a_large_map_is_given_by_means_of_blocks():
    figure = Figure()
    left, right = figure.subplots(1, 2)
    left.fill_between([1, 2, 3], [0, 1, 2], [2, 3, 6], label="_band")
    left.fill_between([1, 2, 3], [0, 0, 0], [1, 1, 1])  # shading
    image = right.imshow(np.arange(128.0 * 128).reshape(128, 128), origin="lower", extent=(0, 1, 0, 2))
    figure.colorbar(image, ax=right, label="height (nm)")
    table = panel_table(figure)
    band, cells = (table[table.panel == letter] for letter in "ab")
    assert np.allclose(band[["x", "y", "y_low", "y_high"]], [[1, 1, 0, 2], [2, 2, 1, 3], [3, 4, 2, 6]])
    assert len(cells) == 64 * 64
    assert cells.value.mean() == pytest.approx((128 * 128 - 1) / 2)
    assert np.allclose(cells[["x", "y"]].mean(), [0.5, 1.0])
    assert set(cells.value_label) == {"height (nm)"}
