"""A vector picture carries its points: where they are, to which curve they belong, and their values with errors."""

from __future__ import annotations

import json
import re
import unicodedata
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from contactsim.figures import style
from contactsim.figures.plain_text import plain_text
from contactsim.figures.points import MAX_POINTS, figure_points
from contactsim.figures.vector import write_vector


@pytest.mark.parametrize(
    ("label", "text"),
    [
        (r"relative contact area $a_{\mathrm{rel}}$", "relative contact area a_{rel}"),
        (r"$\kappa_r^{1D}$", "κ_{r}^{1D}"),
        (r"$K\bar h/(E^*\bar g)$", "Kh̄/(E*ḡ)"),
        (r"$\langle\bar F\rangle$", "⟨F̄⟩"),
        (r"pull-off $-\bar L_{\mathrm{c}}$", "pull-off −L̄_{c}"),
        (r"$T_{\mathrm{if},t}\,\delta_t/\varphi_t$", "T_{if,t}δ_{t}/φ_{t}"),
        (r"$\bar g_r$ over the contact", "ḡ_{r} over the contact"),
        ("error (%)", "error (%)"),
    ],
)
def test_a_label_becomes_plain_text_with_its_indices(label, text):
    assert plain_text(label) == unicodedata.normalize("NFC", text)


@pytest.fixture
def panel():
    figure = Figure(figsize=(4, 3), layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel="$x$", ylabel=r"$\kappa$", xscale="log")
    return axes


def points_of(axes, tmp_path):
    write_vector(axes.figure, tmp_path / "figure.svg")
    picture = ElementTree.parse(tmp_path / "figure.svg").getroot()
    return json.loads(picture.find("{http://www.w3.org/2000/svg}desc").text), picture


def test_points_stand_where_their_markers_are_drawn(panel, tmp_path):
    panel.plot([1, 10, 100], [2.0, 5.0, 3.0], "o", color="#ff0000")
    (curve,), picture = points_of(panel, tmp_path)
    uses = picture.iter("{http://www.w3.org/2000/svg}use")
    drawn = [(float(use.get("x")), float(use.get("y"))) for use in uses if "#ff0000" in use.get("style", "")]
    assert np.allclose(drawn, curve["places"], atol=0.06)
    assert curve["x"] == ["1", "10", "100"]
    assert curve["y"] == ["2", "5", "3"]
    assert curve["axes"] == ["x", "κ"]
    assert curve["colour"] == "#ff0000"


def test_the_length_of_an_error_bar_is_the_error(panel):
    style.errorbars(panel, [1, 2, 3], [1.0, 2.0, 3.0], [0.1, np.nan, 0.25], label="curve")
    (curve,) = figure_points(panel.figure)
    assert curve["y"] == ["1 ± 0.1", "2", "3 ± 0.25"]
    assert curve["name"] == "curve"


def test_points_outside_the_panel_are_left_out(panel):
    panel.plot([1, 10, 100, 1000], [1, 2, np.nan, 4])
    panel.set(xlim=(5, 2000))
    (curve,) = figure_points(panel.figure)
    assert curve["x"] == ["10", "1000"]


def test_of_a_long_curve_points_are_chosen_evenly_with_its_ends(panel):
    x = np.linspace(1, 2, 5000)
    panel.plot(x, x)
    (curve,) = figure_points(panel.figure)
    assert len(curve["x"]) == MAX_POINTS
    assert (curve["x"][0], curve["x"][-1]) == ("1", "2")


def test_guides_across_the_panel_are_no_points(panel):
    panel.axhline(1.0)
    panel.axvline(1.0)
    assert figure_points(panel.figure) == []


def test_a_curve_is_named_by_what_the_legend_says_of_its_colour_and_marker(panel):
    panel.plot([1, 2], [1, 2], "s--", color=style.WHOLE)
    panel.plot([1, 2], [2, 1], "-", color=style.CONTACT, alpha=style.FAINT)
    handles = style.colour_handles({r"$\kappa$": style.WHOLE, r"$\kappa_r$": style.CONTACT})
    handles += style.hurst_handles([0.2, 0.5]) + style.opacity_handles({"counted": style.FAINT})
    panel.legend(handles=handles)
    assert [curve["name"] for curve in figure_points(panel.figure)] == ["κ, H=0.5", "κ_{r}, counted"]


def test_a_curve_outside_the_legend_is_named_by_its_label_without_the_underscore(panel):
    panel.plot([1, 2], [1, 2], label=r"_$H=0.2$, corrected")
    panel.plot([1, 2], [2, 1], label="listed")
    panel.legend()
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["listed"]
    assert [curve["name"] for curve in figure_points(panel.figure)] == ["H=0.2, corrected", "listed"]


def test_a_map_tells_the_values_that_its_colours_stand_for(panel):
    panel.set_xscale("linear")
    mesh = panel.pcolormesh([0, 1, 2], [0, 1], [[3.0, 4.5]])
    panel.figure.colorbar(mesh, ax=panel, label=r"$\sigma$ (GPa)")
    (cells,) = figure_points(panel.figure)
    assert cells["values"] == ["3", "4.5"]
    assert cells["axes"] == ["x", "κ", "σ (GPa)"]
    assert cells["x"] == ["0.5", "1.5"]


def test_what_a_legend_cannot_tell_apart_is_left_out_of_the_name(panel):
    panel.plot([1, 2], [1, 2], "o-", color=style.WHOLE)
    handles = [Line2D([], [], color=style.GREY, marker="o", label=label) for label in ("one", "other")]
    panel.legend(handles=[*handles, *style.colour_handles({"red": style.WHOLE})])
    assert [curve["name"] for curve in figure_points(panel.figure)] == ["red"]


def test_the_same_figure_gives_the_same_file(tmp_path):
    texts = []
    for name in ("first", "second"):
        figure = Figure(figsize=(3, 2))
        axes = figure.subplots()
        axes.plot([1, 2], [1, 2], "o")
        axes.pcolormesh(np.random.default_rng(1).random((60, 60)))
        write_vector(figure, tmp_path / f"{name}.svg")
        texts.append((tmp_path / f"{name}.svg").read_text(encoding="utf-8"))
    assert texts[0] == texts[1]
    assert len(re.findall("<path", texts[0])) < 200, "a large mesh is drawn as pixels"
