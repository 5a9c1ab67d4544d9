"""Maps of a pressed surface: true to the solution, in even colours, with units and a round scale bar."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from matplotlib import colormaps
from matplotlib.figure import Figure

import contactsim
from contactsim import dataset
from contactsim.errors import InputError
from contactsim.figures import ch3, maps
from contactsim.figures.parts import scale_bar
from contactsim.simulation import simulate
from contactsim.solvers.registry import make_solver
from contactsim.study.study import Study

NY, NX, SPACING = 24, 48, (3.0, 2.0)
LENGTHS = (NY * SPACING[0], NX * SPACING[1])


def hills(ny=NY, nx=NX):
    """Two crests along y and three along x, not of one height."""
    y, x = 2 * np.pi * np.arange(ny)[:, None] / ny, 2 * np.pi * np.arange(nx) / nx
    return np.cos(2 * y) + np.cos(3 * x) + 0.3 * np.cos(x)


def pressed(pressure=0.05, **options):
    given = {"spacing": SPACING, "contact_modulus": 1.0, "mean_pressure": pressure}
    return contactsim.press(hills(), **given | options)


def drawn(figure):
    """The three maps and their colour bars."""
    return figure.axes[:3], figure.axes[3:]


def refusal(call):
    with pytest.raises(InputError) as caught:
        call()
    return caught.value


def test_a_result_is_drawn_with_all_that_it_holds_and_in_its_own_units():
    result = pressed()
    panels, bars = drawn(maps.plot_result(result, spacing=SPACING))
    contact, pressure, gap = (panel.images[0].get_array() for panel in panels)
    assert np.array_equal(contact, result.contact)
    assert np.allclose(pressure, result.pressure * 1e3, rtol=1e-12)  # MPa
    assert np.array_equal(gap[~result.contact], result.gap[~result.contact])
    assert not gap[result.contact].any()
    labels = [bar.get_ylabel() for bar in bars]
    assert labels == ["fraction in contact", "pressure $p$ (MPa)", "gap $g$ (nm)"]
    for panel in panels:
        assert panel.images[0].origin == "lower"
        assert panel.images[0].get_extent() == [0, LENGTHS[1], 0, LENGTHS[0]]
        assert panel.get_aspect() == 1
    assert f"{result.relative_contact_area:.3g}" in panels[0].get_title(loc="right")
    assert panels[1].get_title(loc="right") == "mean $p$ = 50 MPa"


@pytest.mark.parametrize("pressure", [0.0, 1e-3, 0.05, 5.0])
def test_the_colours_hold_all_that_is_drawn_from_no_contact_to_full(pressure):
    result = pressed(pressure)
    for panel in maps.plot_result(result, spacing=SPACING).axes[:3]:
        low, high = panel.images[0].get_clim()
        assert low <= panel.images[0].get_array().min() <= panel.images[0].get_array().max() <= high
        assert low <= 0 < high
    assert result.relative_contact_area == {0.0: 0.0, 5.0: 1.0}.get(pressure, result.relative_contact_area)


def test_the_numbers_are_those_of_the_solution_not_of_the_pixels():
    result = pressed()
    solved = maps.SurfaceFields(result.pressure, result.gap, LENGTHS)
    table = maps.plot_fields(solved, list(Figure(layout="constrained").subplots(1, 3))).set_index("map")
    assert list(table["mean"]) == pytest.approx([result.relative_contact_area, 0.05, result.gap.mean()], rel=1e-3)
    assert table.largest["pressure"] == result.pressure.max()
    assert list(table.unit) == ["1", "GPa", "nm"]
    assert (table.pixel_points == 1).all()


@pytest.mark.parametrize("shape", [(8, 8), (7, 10), (3, 1)])
@pytest.mark.parametrize("block", [1, 2, 3])
def test_a_pixel_is_the_mean_of_its_points_and_the_last_may_have_fewer(shape, block):
    values = np.random.default_rng(1).random(shape)
    pixels = maps.block_means(values, block)
    assert pixels.shape == (-(-shape[0] // block), -(-shape[1] // block))
    for (row, column), pixel in np.ndenumerate(pixels):
        part = values[row * block : (row + 1) * block, column * block : (column + 1) * block]
        assert pixel == pytest.approx(part.mean(), rel=1e-12)


def test_a_fine_grid_is_reduced_and_its_panels_end_where_the_surface_does():
    ny, nx = 600, 1200
    contact = np.zeros((ny, nx))
    contact[:, ::2] = 1.0  # stripes that picking every third point would lose or turn into others
    axes = list(Figure(layout="constrained").subplots(1, 3))
    table = maps.plot_fields(maps.SurfaceFields(contact, 1 - contact, (600.0, 1200.0)), axes)
    image = axes[0].images[0]
    assert image.get_array().shape == (200, 400)
    assert set(np.unique(image.get_array().round(12))) == {round(1 / 3, 12), round(2 / 3, 12)}
    assert (table.pixel_points == 3).all()
    odd = maps.SurfaceFields(contact[:, :1199], 1 - contact[:, :1199], (600.0, 1199.0))
    axes = list(Figure(layout="constrained").subplots(1, 3))
    maps.plot_fields(odd, axes)
    assert axes[0].images[0].get_extent() == [0, pytest.approx(1200), 0, pytest.approx(600)]  # one point is beyond
    assert axes[0].get_xlim() == (0, 1199)


@pytest.mark.parametrize(
    ("most", "length"), [(1.0, 1.0), (0.999, 0.5), (0.3, 0.2), (24000.0, 20000.0), (6e-9, 5e-9), (4.9, 2.0), (50, 50)]
)
def test_a_scale_bar_is_one_two_or_five_times_a_power_of_ten(most, length):
    assert scale_bar.round_length(most) == pytest.approx(length, rel=1e-12)


@pytest.mark.parametrize(
    ("width", "unit", "text", "share"),
    [
        (80000.0, "nm", "20 µm", 0.25),
        (96.0, "nm", "20 nm", 20 / 96),
        (2.0, "nm", "500 pm", 0.25),
        (3.4, "mm", "1 mm", 1 / 3.4),
        (7.0, "cells", "2 cells", 2 / 7),
        (7.0, "", "2", 2 / 7),
    ],
)
def test_the_scale_bar_is_as_long_on_the_page_as_it_says(width, unit, text, share):
    figure = Figure()
    axes = figure.subplots()
    axes.set_xlim(0, width)
    bar = scale_bar.add_scale_bar(axes, width, unit)
    assert bar.txt_label.get_text() == text
    figure.draw_without_rendering()
    (rectangle,) = bar.size_bar.get_children()
    extent, panel = rectangle.get_window_extent(), axes.get_window_extent()
    assert extent.width / panel.width == pytest.approx(share, rel=1e-9)
    assert extent.x0 == pytest.approx(panel.x0)
    assert extent.y1 < panel.y0  # below the map, which it hides no part of


@pytest.mark.parametrize(
    ("value", "unit", "factor", "shown"),
    [
        (0.002, "GPa", 1e3, "MPa"),
        (1.0, "GPa", 1.0, "GPa"),
        (5e4, "nm", 1e-3, "µm"),
        (1e3, "nm", 1e-3, "µm"),
        (2e-3, "m", 1e3, "mm"),
        (3e5, "Pa", 1e-3, "kPa"),
        (1e-30, "nm", 1.0, "nm"),
        (0.0, "nm", 1.0, "nm"),
        (5e4, "atm", 1.0, "atm"),
        (5e4, "E*", 1.0, "E*"),
    ],
)
def test_units_of_metres_and_pascals_get_the_prefix_that_fits_and_others_stay(value, unit, factor, shown):
    found = scale_bar.fitting_unit(value, unit)
    assert found == (pytest.approx(factor, rel=1e-12), shown)


def lightness(colours):
    """L* of sRGB colours (n, 3), CIE 1976."""
    linear = np.where(colours > 0.04045, ((colours + 0.055) / 1.055) ** 2.4, colours / 12.92)
    luminance = linear @ [0.2126, 0.7152, 0.0722]
    return np.where(luminance > 216 / 24389, 116 * np.cbrt(luminance) - 16, luminance * 24389 / 27)


@pytest.mark.parametrize("name", maps.COLOURS)
def test_colours_fall_evenly_from_light_to_dark(name):
    scale = maps.COLOURS[name]
    scale = colormaps[scale] if isinstance(scale, str) else scale
    light = lightness(scale(np.linspace(0, 1, 17))[:, :3])
    assert (np.diff(light) < 0).all()
    assert np.corrcoef(light, np.arange(17))[0, 1] < -0.998  # of Matplotlib's hot 0.983, of jet 0.25
    if name == "contact":
        assert np.allclose(np.diff(light), -100 / 16, atol=0.6)  # one of 256 shades


@pytest.mark.parametrize("unit", ["nm", "µm"])
def test_units_of_a_result_are_those_given(unit):
    _, bars = drawn(maps.plot_result(pressed(), spacing=SPACING, length_unit=unit, pressure_unit="bar"))
    assert [bar.get_ylabel() for bar in bars[1:]] == ["pressure $p$ (bar)", f"gap $g$ ({unit})"]


# --- datasets -----------------------------------------------------------------------------------------------------

SECTION = {
    "title": "Waves",
    "surface": {"kind": "sinusoid", "length": 64.0, "amplitude": 1.0, "dimensions": 2},
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"mean_pressure": [0.01, 0.02]},
    "points": 16,
    "tolerance": 1e-3,
}


def simulated(**options):
    scene = Study.read("waves", SECTION, "ch9.yaml", 1).runs()[0].setup.scene
    return simulate(scene, points=16, **{"keep": ["fields"]} | options)


def test_one_load_of_a_dataset_is_drawn_like_the_result_of_it():
    data = simulated()
    panels, _ = drawn(maps.plot_maps(data.isel(step=1)))
    kept = data.isel(step=1)
    assert np.allclose(panels[1].images[0].get_array(), kept.pressure * 1e3, rtol=1e-12)
    result = contactsim.press(data.heights.values, spacing=4.0, contact_modulus=1.0, mean_pressure=0.02)
    again, _ = drawn(maps.plot_result(result, spacing=4.0))
    for one, other in zip(panels, again, strict=True):
        assert np.allclose(one.images[0].get_array(), other.images[0].get_array(), atol=1e-9)
        assert one.images[0].get_extent() == other.images[0].get_extent()


def test_what_cannot_be_drawn_is_refused_with_key_and_what_is_allowed():
    line = contactsim.press([0.0, 1.0, 0.5, -1.0], spacing=1.0, contact_modulus=1.0, mean_pressure=0.1)
    error = refusal(lambda: maps.plot_result(line, spacing=1.0))
    assert (error.key, error.value) == ("dimensions", 1)
    assert "surfaces" in error.allowed
    for spacing in (None, 0.0, -1.0, "1", (1.0, 2.0, 3.0), (1.0, np.nan)):
        error = refusal(lambda spacing=spacing: maps.plot_result(pressed(), spacing=spacing))
        assert (error.key, error.value) == ("spacing", spacing)
    lost = pressed(solver=make_solver("conjugate_gradients", budget=1, inner_budget=1), tolerance=1e-12)
    assert refusal(lambda: maps.plot_result(lost, spacing=SPACING)).key == "status"
    data = simulated()
    assert refusal(lambda: maps.plot_maps(data)).key == "step"
    assert refusal(lambda: maps.plot_maps(data.isel(step=0).assign(status=1))).key == "status"
    assert refusal(lambda: maps.plot_maps(simulated(keep=["contact"]).isel(step=0))).key == "keep"


def test_a_line_of_a_study_is_refused(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    error = refusal(lambda: ch3.maps(data, list(Figure(layout="constrained").subplots(1, 3))))
    assert (error.key, error.value) == ("dimensions", 1)


def test_the_figure_shows_one_load_of_the_study_and_says_which(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_surface_map.nc")
    axes = list(Figure(layout="constrained").subplots(1, 3))
    shown = ch3.maps(data, axes).set_index("map")
    one = data.squeeze()
    assert shown["mean"]["contact"] == float(one.relative_contact_area)
    unit = float(one.rms_gradient * one.contact_modulus)
    assert shown["mean"]["pressure"] == pytest.approx(float(one.mean_pressure) / unit, rel=1e-12)
    assert shown["mean"]["gap"] == pytest.approx(float(one.mean_gap), rel=1e-4)  # the residual in contact apart
    places = {"hurst_exponent": one.hurst_exponent.item(), "reduced_pressure": one.reduced_pressure.item()}
    assert all((shown[name] == value).all() for name, value in places.items())
    assert f"$H$ = {places['hurst_exponent']:g}, $p^*$ = {places['reduced_pressure']:g}" in [
        t.get_text() for t in axes[0].texts
    ]
    written = pd.read_csv(made / "results/quick/figures/maps.csv", low_memory=False).dropna(subset="map")
    assert np.allclose(written["mean"], shown["mean"], rtol=1e-12)
