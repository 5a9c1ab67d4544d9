"""A quantity on finer and finer grids, as the figures show it: made-up members of known order."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

from contactsim import dataset
from contactsim.analysis import aggregate, resolution
from contactsim.errors import InputError
from contactsim.figures import ch3, style
from contactsim.figures.parts import ratios as ratio_curves
from contactsim.figures.parts import resolution as resolution_curves
from contactsim.observables.dataset_forms import AVERAGED
from contactsim.study.plan import Plan

CONFIG = Path(__file__).parents[2] / "config"

SURFACE = {"short_cutoff": 2.0, "length": 512.0}
LEVELS = np.array([1.0, 1.2, 1.7])


def made(points, members=3, hurst_exponent=(0.2, 0.8), scale=1.0, surface=SURFACE):
    """Quantities 1 + c/points of first order, each member at its own level."""
    dims = ("points", "hurst_exponent", "member", "reduced_pressure")
    shape = (len(points), len(hurst_exponent), members, 2)
    level = LEVELS[:members].reshape(1, 1, -1, 1)
    values = scale * (level + 256 / np.reshape(points, (-1, 1, 1, 1))) * np.ones(shape)
    places = {
        "points": list(points),
        "hurst_exponent": list(hurst_exponent),
        "member": range(members),
        "reduced_pressure": [0.01, 0.1],
    }
    data = xr.Dataset(dict.fromkeys(resolution.QUANTITIES, (dims, values)), places)
    data["status"] = (dims, np.zeros(shape, np.int8))
    data = data.merge(aggregate.ensemble_means(data, AVERAGED))
    if len(points) == 3:
        data = data.merge(aggregate.finer_grid_limits(data))
    return dataset.stamp(data, "made", {"surface": surface}, "source")


def place(shown, quantity, hurst_exponent, load):
    """The rows of one place, by grid."""
    return shown.query(
        f"quantity == '{quantity}' and hurst_exponent == {hurst_exponent} and reduced_pressure == {load}"
    ).set_index("grid")


COARSER, FINER = made([1024, 2048, 4096]), made([8192], members=1, hurst_exponent=[0.2])


def test_the_table_has_means_changes_member_by_member_and_limits():
    shown = resolution.grid_table(COARSER, FINER)
    one = place(shown, "kappa", 0.2, 0.01)
    assert list(one.index) == ["4 points", "8 points", "16 points", "32 points", "limit"]
    mean = LEVELS.mean()
    assert np.allclose(one.value, [mean + 1 / 4, mean + 1 / 8, mean + 1 / 16, mean + 1 / 32, mean], rtol=1e-12)
    assert np.allclose(one.above_common[:4], [3 / 16, 1 / 16, 0, -1 / 32], atol=1e-12)
    assert np.allclose(one.above_finest, [7 / 32, 3 / 32, 1 / 32, 0, -1 / 32], atol=1e-12)
    assert np.allclose(one.above_common_standard_error[:3], 0, atol=1e-12)  # all members change alike
    assert one.above_common_standard_error[3:].isna().all()  # one member
    error = LEVELS.std(ddof=1) / np.sqrt(3)
    assert np.allclose(one.standard_error.drop("32 points"), error, rtol=1e-9)
    assert one.order["limit"] == pytest.approx(1.0, rel=1e-9)
    assert list(place(shown, "kappa", 0.8, 0.01).index) == ["4 points", "8 points", "16 points", "limit"]


def test_what_a_grid_costs_is_said_in_words():
    text = "\n".join(resolution.change_texts(resolution.grid_table(COARSER, FINER), "kappa_r", "8 points"))
    for part in (
        "from 16 points to 8 points: +0.062 to +0.062",
        "from 32 points to 8 points: +0.094",
        "from the limit to 8 points: +0.125",
        "order observed: 1.0",
    ):
        assert part in text


def test_grids_are_drawn_by_points_per_wavelength_and_limits_beside_them():
    axes = Figure().subplots()
    resolution_curves.plot_factor(resolution.grid_table(COARSER, FINER), "kappa", axes)
    curves = [container.lines[0] for container in axes.containers if len(container.lines[0].get_xdata()) > 1]
    assert [list(curve.get_xdata()) for curve in curves] == [[4, 8, 16, 32]] * 2 + [[4, 8, 16]] * 2
    limits = [container.lines[0] for container in axes.containers if len(container.lines[0].get_xdata()) == 1]
    assert np.allclose([limit.get_ydata()[0] for limit in limits], LEVELS.mean(), rtol=1e-12)


def test_ratios_are_taken_at_equal_points_per_wavelength():
    lines = made([256, 512, 1024], scale=0.9, surface=SURFACE | {"length": 128.0})
    shown = resolution.ratio_table(lines, COARSER)
    one = place(shown, "kappa_r", 0.8, 0.1)
    mean = LEVELS.mean()
    assert one.value["8 points"] == pytest.approx(0.9 * (mean + 1 / 2) / (mean + 1 / 8), rel=1e-12)
    assert one.value["limit"] == pytest.approx(0.9, rel=1e-9)
    assert one.error["limit"] == pytest.approx(0.9 * np.sqrt(2 / 3) * LEVELS.std(ddof=1) / mean, rel=0.05)
    axes = Figure().subplots()
    ratio_curves.plot_equal_grids(axes, shown[shown.quantity == "kappa_r"], "16 points", style.CONTACT)
    limits = [container.lines[0].get_ydata() for container in axes.containers[1::2]]
    assert np.allclose(limits, 0.9, rtol=1e-9)
    assert len(axes.containers) == 4  # two Hurst exponents, on the grid and in the limit


def test_ratios_of_ensembles_on_unequal_grids_are_refused():
    lines = made([512, 1024, 2048], scale=0.9, surface=SURFACE | {"length": 128.0})
    with pytest.raises(InputError, match=r"points: got \[4.0, 8.0, 16.0\]; allowed: .*\[8.0, 16.0, 32.0\]"):
        resolution.ratio_table(lines, COARSER)


@pytest.mark.parametrize("tier", ["quick", "standard", "full"])
def test_lines_and_surfaces_are_refined_through_the_same_grids_at_every_tier(tier):
    studies = Plan.read(CONFIG, tier).studies
    counts = []
    for name in ("line_resolution", "surface_resolution"):
        settings = studies[name].settings
        surface = settings["surface"]
        counts.append(np.array(settings["vary"]["points"]) * surface["short_cutoff"] / surface["length"])
    np.testing.assert_allclose(*counts, rtol=1e-12)


def test_the_thesis_is_drawn_where_it_gives_a_value_and_all_values_are_named():
    axes = list(Figure().subplots(1, 4))
    ch3.fig_3_4_grid(COARSER, FINER, axes, kappa=2.2, kappa_r=1.88)
    dashed = [
        [line.get_ydata()[0] for line in panel.lines if line.get_color() == style.EXACT and len(line.get_ydata()) == 2]
        for panel in axes
    ]
    assert dashed == [[2.2], [2.2], [1.88], [1.88]]
    assert "thesis, 2.20 and 1.88" in [text.get_text() for text in axes[-1].get_legend().get_texts()]
