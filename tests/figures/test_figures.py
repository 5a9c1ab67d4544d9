from __future__ import annotations

import subprocess
import sys
from importlib import import_module

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from contactsim import dataset
from contactsim.analysis import dataset_summary, wording
from contactsim.analysis.mean_errors import estimate_trend, grid_error
from contactsim.analysis.quantities import mean_quantity
from contactsim.analysis.rounding import number_text, rounded_texts, short_number
from contactsim.contact.loading import pressures
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.half_space import HalfSpace
from contactsim.evaluation.work_precision.case_config import MEASURED_QUANTITIES
from contactsim.figures import ch3, ch5, layout, round_contacts, sketch, style
from contactsim.figures.diagnostics import claims
from contactsim.interface.hard_wall import HardWall
from contactsim.reference import hard_wall
from contactsim.study.figure_plan import PICTURE_ENDINGS
from contactsim.study.law_table import tabulate_law
from contactsim.study.plan import Plan
from contactsim.study.quantity_names import quantities
from contactsim.surfaces.shapes import Flat, Sinusoid
from contactsim.variables import RESULTS
from support.places import ROOT

PLAN = Plan.read(ROOT / "config", "quick")


def figure_data(made, name):
    """The datasets that a figure shows, as it shows them."""
    figure = PLAN.figures[name]
    if figure.settings["law"] is not None:
        return [tabulate_law(figure.settings["law"])]
    paths = [made / f"results/quick/datasets/{PLAN.dataset_name(study)}.nc" for study in figure.studies]
    return [layout.selected(dataset.load_dataset(path), figure.settings["select"]) for path in paths]


@pytest.mark.parametrize("name", PLAN.figures)
def test_every_panel_of_a_figure_has_labels_and_finite_data_and_its_csv_holds_what_is_plotted(made, name):
    settings = PLAN.figures[name].settings
    _, panels = layout.empty_figure(settings, "footer", settings["rows"])
    plot = getattr(import_module(PLAN.figures[name].module), name)
    table = plot(*figure_data(made, name), panels if len(panels) > 1 else panels[0], **settings["reference"])
    for panel in panels:
        lines = [np.asarray(line.get_ydata(), float) for line in panel.lines]
        assert (
            any(np.isfinite(line).sum() > 1 for line in lines)
            or panel.images
            or panel.collections
            or panel.tables
            or panel.patches
        )
        if panel.axison and not panel.images:
            assert panel.get_xlabel() or panel.get_xticklabels()[0].get_text()
            assert panel.get_ylabel() or panel.get_yticklabels()[0].get_text()
    written = pd.read_csv(made / f"results/quick/figures/{name}.csv", low_memory=False)
    if "point" in written:  # the table of what is drawn comes first
        written = written[written.point.isna()][list(table)]
    assert list(written) == list(table)
    numbers = table.select_dtypes("number")
    assert np.allclose(written[list(numbers)].to_numpy(float), numbers.to_numpy(float), rtol=1e-12, equal_nan=True)


def test_plotting_chapter_3_imports_few_modules_of_the_package():
    code = "import sys, contactsim.figures.layout, contactsim.figures.ch3, contactsim.dataset\n"
    code += "print(*sorted(name for name in sys.modules if name.startswith('contactsim')))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    modules = run.stdout.split()
    assert len(modules) <= 73, modules  # trends and errors are those of verdicts, from the code that judges
    rooms = {name.split(".")[1] for name in modules if "." in name}
    assert not rooms & {"study", "error_control", "evaluation", "simulation", "paths"}


def test_importing_figures_changes_no_setting_of_matplotlib():
    code = "import matplotlib as mpl; before = dict(mpl.rcParams); import contactsim.figures.ch5\n"
    code += "print(dict(mpl.rcParams) == before)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "True"


def test_a_footer_says_grid_members_losses_and_time(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    costs = pd.read_csv(made / "results/quick/costs/ch3_rough_line.csv")
    text = dataset_summary.dataset_summary(data, costs)
    for part in (
        "quick tier",
        "131072 points, 32 per shortest wavelength (thesis 64)",
        "3 members",
        "0 of 45 solutions unconverged",
        "grid error up to: κ ",
        f"study solved in {dataset_summary.seconds_text([costs])}",
    ):
        assert part in text
    data["status"][0, 0, 0] = 1
    assert "1 of 45 solutions unconverged" in dataset_summary.dataset_summary(data, costs)


@pytest.mark.parametrize(("seconds", "text"), [(0.123, "0.12 CPU s"), (99.7, "100 CPU s"), (1265.4, "1265 CPU s")])
def test_a_footer_has_no_powers_of_ten_in_its_seconds(seconds: float, text: str):
    assert dataset_summary.seconds_text([pd.DataFrame({"seconds": [seconds / 2]})] * 2) == text


def test_the_footer_of_a_figure_has_the_range_of_grids_and_members_of_its_studies(made):
    data = rough(made, "rough_line", "rough_surface", "line_resolution", "surface_resolution")
    text = dataset_summary.sources_summary(data, [pd.DataFrame({"seconds": [1.0, 1.5]})] * 4)
    for part in ("quick tier · ", " to 131072 points, ", "per shortest wavelength · ", "3 members · ", "10 CPU s"):
        assert part in text
    assert dataset_summary.sources_summary(data[:1] * 2, [pd.DataFrame({"seconds": [1.0]})] * 2) == (
        "quick tier · 131072 points, 32 per shortest wavelength (thesis 64) · 3 members · all 90 converged · 2 CPU s"
    )


def test_a_footer_tells_of_the_loads_shown_and_of_no_others(made, tmp_path, monkeypatch):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_smooth_line.nc")
    data["status"][..., data.contact_ratio.values < 0.05] = 1
    plan, footers = PLAN.figure_settings("table_3_1"), []
    assert plan["settings"]["select"] == {"contact_ratio": [0.05, 0.25]}
    empty = layout.empty_figure
    monkeypatch.setattr(layout, "empty_figure", lambda own, text, rows: footers.append(text) or empty(own, text, rows))
    targets = {kind: tmp_path / f"table.{kind}" for kind in PICTURE_ENDINGS}
    names = ("ch3_smooth_line", "ch3_smooth_surface")
    costs = [pd.read_csv(made / f"results/quick/costs/{name}.csv") for name in names]
    other = dataset.load_dataset(made / f"results/quick/datasets/{names[1]}.nc")
    layout.write_figure(plan, [data, other], costs, targets)
    assert pd.read_csv(targets["csv"]).contact_ratio.between(0.05, 0.25).all()
    assert "all 12 converged" in footers[0]


def test_the_rough_lines_are_drawn_corrected_beside_the_estimator_of_the_thesis(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    axes = list(Figure().subplots(1, 4))
    shown = ch3.fig_3_2(data, axes, kappa_r=1.75)
    assert len(axes[1].containers) == 4 * data.hurst_exponent.size  # κ and κ_r by both estimators
    assert len(axes[2].containers) == 2 * data.hurst_exponent.size
    assert any(np.allclose(line.get_ydata(), 1.75) for line in axes[1].lines)
    assert {"kappa_r_corrected_mean", "kappa_r_corrected_standard_error", "kappa_r_grid_error"} <= set(shown)
    counted, corrected = (container.lines[0] for container in axes[2].containers[:2])
    means = data.sel(hurst_exponent=0.2)
    assert np.array_equal(counted.get_ydata(), means.kappa_r_mean)
    assert np.array_equal(corrected.get_ydata(), means.kappa_r_corrected_mean)
    assert np.array_equal(corrected.get_xdata(), means.reduced_pressure_contact_corrected_mean)
    assert counted.get_alpha() < 1
    drawn = axes[3].lines[3].get_ydata()  # corrected κ_r of the first Hurst exponent, in per cent
    expected = 100 * grid_error(means, "kappa_r_corrected") / means.kappa_r_corrected_mean
    assert np.array_equal(drawn, expected)
    assert len(axes[3].lines) == 4 * data.hurst_exponent.size


def test_the_text_in_a_figure_gives_the_trend_that_verdicts_judge_and_no_largest_difference(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    axes = list(Figure().subplots(1, 4))
    ch3.fig_3_2(data, axes, kappa_r=1.75)
    trend = estimate_trend(data, "kappa_r_corrected", "hurst_exponent")
    (text,) = (text.get_text() for text in axes[2].texts)
    assert f"{rounded_texts(100 * trend.value, 100 * trend.error)[0]} ±" in text
    assert np.isfinite(trend.ensemble_error)
    assert np.isfinite(trend.grid_error)


def test_without_a_measured_grid_error_the_rough_lines_are_drawn_all_the_same(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    axes = list(Figure().subplots(1, 4))
    ch3.fig_3_2(data.drop_vars(name for name in data if name.endswith("grid_error")), axes, kappa_r=1.75)
    assert not axes[3].lines


def smooth(made):
    return [dataset.load_dataset(made / f"results/quick/datasets/ch3_smooth_{kind}.nc") for kind in ("line", "surface")]


def test_cylinder_and_sphere_are_drawn_beside_the_exact_lines(made):
    axes = Figure().subplots()
    shown = round_contacts.fig_3_1(*smooth(made), axes)
    for body, exact, within in (("cylinder", 8 / (np.pi * np.sqrt(3)), 0.01), ("sphere", 1.666, 0.03)):
        assert any(np.allclose(line.get_ydata(), exact, rtol=1e-3) for line in axes.lines)
        inside = shown[(shown.body == body) & shown.contact_ratio.between(0.05, 0.25)]
        assert np.allclose(inside.kappa_r, exact, rtol=within)
        assert np.allclose(inside.kappa_r_corrected, exact, rtol=within)
    drawn = [container.lines[0] for container in axes.containers]
    assert {line.get_markersize() for line in drawn} == {6.0, 2.6}  # the corrected one fits into the other
    cylinder = smooth(made)[0]
    assert any(np.array_equal(line.get_ydata(), cylinder.kappa_r_array.values.ravel()) for line in axes.lines)


def test_the_bar_of_counted_points_leads_to_where_the_next_grid_may_be(made):
    axes, line = Figure().subplots(), smooth(made)[0]
    round_contacts.fig_3_1(*smooth(made), axes)
    (bars,) = axes.containers[0].lines[2]
    ends = np.array([segment[:, 1] for segment in bars.get_segments()])
    inside = line.isel(member=0).sel(contact_ratio=slice(0, 0.26))
    value, change = inside.kappa_r.values, inside.kappa_r_grid_change.values
    assert np.allclose(np.sort(np.stack([value, value + change]), axis=0), ends.T)
    assert (change < 0).any()


def test_the_table_lists_exact_and_computed(made):
    axes = Figure().subplots()
    rows = round_contacts.table_3_1(*smooth(made), axes)
    assert list(rows) == ["body", *round_contacts.TABLE_HEADS]
    line, sphere = (rows[rows.body == body] for body in ("cylinder", "sphere"))
    assert np.allclose(line.area_exact, 2 * line.contact_ratio)
    assert (line.area_array <= line.area_exact).all()
    assert sphere.area_array.isna().all()
    assert np.allclose(line.area_corrected, line.area_array, rtol=0.02)  # an edge is rounded to a point
    cells = [cell.get_text().get_text() for cell in axes.tables[0].get_celld().values()]
    assert {"–", "0.01"} <= set(cells)
    assert np.allclose(line.load, np.pi / 4 * line.contact_ratio**2)
    assert np.allclose(sphere.load, 4 / 3 * sphere.contact_ratio**3)
    many = sphere[sphere.contact_ratio >= 0.05]
    assert np.allclose(many.area, np.pi * many.contact_ratio**2, rtol=0.03)


def rough(made, *names):
    return [dataset.load_dataset(made / f"results/quick/datasets/ch3_{name}.nc") for name in names]


def test_surfaces_are_drawn_with_the_values_of_the_thesis_and_their_distance_from_them(made):
    (surface,) = rough(made, "rough_surface")
    axes = list(Figure().subplots(1, 4))
    ch3.fig_3_4(surface, axes, kappa=2.2, kappa_r=1.88)
    assert {2.2, 1.88} <= {line.get_ydata()[0] for line in axes[1].lines if len(set(line.get_ydata())) == 1}
    drawn = axes[2].containers[0].lines[0].get_ydata()  # corrected κ of the first Hurst exponent
    assert np.allclose(drawn, 100 * (surface.kappa_corrected_mean.sel(hurst_exponent=0.2) / 2.2 - 1))


def test_ratios_of_lines_to_surfaces_have_one_range_and_a_label_each(made):
    data = rough(made, "rough_line", "rough_surface", "line_resolution", "surface_resolution")
    axes = list(Figure().subplots(1, 2))
    shown = ch3.fig_3_5(*data, axes, ratio=0.92)
    own = shown.query("grid == 'own' and quantity == 'kappa_r_corrected' and hurst_exponent == 0.5")
    line, surface = (part.sel(hurst_exponent=0.5).kappa_r_corrected_mean for part in data[:2])
    assert np.allclose(own.value * surface, line.sel(reduced_pressure=surface.reduced_pressure))
    assert (own.error > 0).all()
    assert axes[0].get_ylim() == axes[1].get_ylim()
    assert axes[0].get_ylabel() != axes[1].get_ylabel()
    for value in (0.92, hard_wall.CYLINDER_KAPPA_R / hard_wall.SPHERE_KAPPA_R):
        levels = [[line.get_ydata()[0] for line in panel.lines if len(line.get_ydata()) == 2] for panel in axes]
        assert value in levels[1]
        assert value not in levels[0]  # they are ratios of κ_r


def test_the_fits_are_given_as_the_curves_that_they_draw(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc").sel(reduced_pressure=slice(0, 0.11))
    axes = list(Figure().subplots(1, 2))
    shown = ch3.fig_3_3(data, axes)
    assert len(shown) == data.fit_b1.size * data.reduced_pressure.size
    drawn = shown.query("fit_limit == 0.1 and weighting == 'area' and fitted != 'all'")
    assert np.allclose(drawn.kappa_fit, mean_quantity(data, "kappa_fit").values.ravel(), rtol=1e-12)  # fitted anew
    fit = data.sel(fitted="all", weighting="logarithm", fit_limit=0.1)
    words = [text.get_text() for text in axes[1].get_legend().get_texts()]
    value, half_width = rounded_texts(fit.fit_b1_corrected.item(), fit.fit_b1_corrected_half_width.item())
    assert any(f"{value} ± {half_width}" in text for text in words)
    assert (data.fit_b1 < data.fit_b1_corrected).all()  # counted points give the larger area


def test_compressible_bodies_are_drawn_with_what_the_layer_changes(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch5_nonadhesive_compressible.nc")
    axes = list(Figure().subplots(1, 4))
    shown = ch5.fig_5_2(data, axes, kappa_r=1.75)
    variants = data.hurst_exponent.size * data.poisson_ratio.size * data.thickness.size
    assert len(axes[0].containers) == variants
    assert any(np.allclose(line.get_ydata(), 1.75) for line in axes[1].lines)
    assert len(shown) == variants * data.reduced_pressure.size
    thick = shown.thickness == data.thickness.values.max()
    names = [
        f"{name}_change{error}" for name in ("kappa_r", "relative_contact_area") for error in ("", "_standard_error")
    ]
    assert (shown[thick][names] == 0).all(axis=None)
    assert (shown[~thick]["relative_contact_area_change"] != 0).all()


def test_on_a_half_space_poissons_ratio_changes_no_contact(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch5_nonadhesive_compressible.nc")
    assert np.allclose(data.rms_height, 10.0, rtol=1e-12)
    thick = data.sel(thickness=data.thickness.max())
    assert not thick.relative_contact_area.diff("poisson_ratio").any()
    assert data.relative_contact_area.sel(thickness=640.0).diff("poisson_ratio").any()


def test_a_hurst_exponent_outside_the_thesis_is_drawn_too():
    assert style.hurst_look(0.35)["marker"] == "x"
    assert style.hurst_colour(0.35) not in style.HURST_COLOURS.values()
    assert style.poisson_look(0.3)["marker"] not in [marker for marker, _ in style.POISSON_LOOKS.values()]


def test_a_measured_surface_has_points_and_no_wavelength():
    settings = {"surface": {"kind": "measured"}, "thesis_points": None}
    assert dataset_summary.grid_text(settings, 100) == "100 points"


@pytest.mark.parametrize(
    ("low", "high", "labels"),
    [
        (0.004, 0.03, ["0.005", "0.01", "0.02"]),
        (0.0013, 0.06, ["0.002", "0.005", "0.01", "0.02", "0.05"]),  # one decade alone says little
        (3e7, 2.5e8, [r"$5\times10^{7}$", "$10^{8}$", r"$2\times10^{8}$"]),
        (0.05, 300.0, ["$10^{-1}$", "$10^{0}$", "$10^{1}$", "$10^{2}$"]),
        (1e-9, 1.5, ["$10^{-9}$", "$10^{-7}$", "$10^{-5}$", "$10^{-3}$", "$10^{-1}$"]),
    ],
)
def test_ticks_of_a_logarithmic_axis_lie_inside_its_range(low, high, labels):
    axes = Figure().subplots()
    axes.set(xscale="log", xlim=(low / 2, high * 2))
    style.set_log_ticks(axes.xaxis, low, high)
    format_tick = axes.xaxis.get_major_formatter()
    assert [format_tick(at) for at in axes.xaxis.get_majorticklocs()] == labels
    assert all(low <= at <= high for at in axes.xaxis.get_minorticklocs())


@pytest.mark.parametrize(("values", "span"), [([0.2], 10.0), ([0.2, 0.3], 10.0), ([1e-3, 1.0], 1690.0), ([], 10.0)])
def test_the_range_of_a_logarithmic_axis_holds_its_values_and_a_factor_of_ten(values, span):
    low, high = style.log_range(pd.Series(values, dtype=float))
    assert high / low == pytest.approx(span)
    assert all(low < value < high for value in values)


# --- the table of claims ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "errors", "shown"),
    [
        (0.012689, (0.00381, 0.0249), ["0.013", "0.004", "0.025"]),
        (0.012689, (0.00381, 0.0), ["0.0127", "0.0038", "0"]),
        (0.0094952, (8.5e-5, 0.0), ["0.009495", "0.000085", "0"]),
        (1.4682, (0.0, 0.0), ["1.468", "0", "0"]),
        (7.0, (0.0, 0.0), ["7", "0", "0"]),
        (1.7476, (0.0996, 0.996), ["1.7", "0.1", "1.0"]),
        (0.2061, (0.01, np.nan), ["0.206", "0.010", "not known"]),
        (np.nan, (np.nan, np.nan), ["not known"] * 3),
        (1234.6, (56.0, 0.0), ["1235", "56", "0"]),
        (5.6e-17, (5.08e-17, np.nan), ["0", "0", "not known"]),
        (1.4e-11, (), ["1.4e-11"]),
        (0.868689879, (0.0, 3.6e-9), ["0.86869", "0", "< 0.00001"]),
        (4.49107214168253233, (0.69, 8.9e-16), ["4.49", "0.69", "0"]),
        (-135.02724769, (0.0, 2.1e-7), ["-135.03", "0", "< 0.01"]),
    ],
)
def test_a_value_has_two_digits_of_its_total_error_and_five_at_most(value, errors, shown):
    assert rounded_texts(value, *errors) == shown


def verdict_row(measure, value, *errors):
    return {"measure": measure, "value": value, "ensemble_error": errors[0], "grid_error": errors[1]}


@pytest.mark.parametrize(
    ("row", "shown"),
    [
        (verdict_row("mean of kappa", 1.4682, 0.0, 0.0012), "1.4682 ± none ± 0.0012"),
        (verdict_row("mean of kappa", 1.4682, np.nan, 0.0012), "1.4682 ± not known ± 0.0012"),
        (verdict_row("mean of kappa", np.nan, np.nan, np.nan), "not known"),
        (verdict_row("exact number: law_remainder", 1.4142, 0.0, 0.0), "1.414 (exact)"),
        (verdict_row("rising_steps of kappa along x", 309079456.0, np.nan, np.nan), "worst step > 99 errors"),
        (verdict_row("rising_steps of kappa along x", -2.27, np.nan, np.nan), "worst step -2.3 errors"),
    ],
)
def test_words_tell_no_error_from_one_that_is_not_known(row, shown):
    assert number_text(row) == shown


@pytest.mark.parametrize(
    ("value", "shown"), [(np.nan, "–"), (1.4e8, "> 99"), (3.4e-16, "0"), (2.04, "2"), (0.32, "0.32")]
)
def test_margins_and_places_are_short(value, shown):
    assert short_number(value) == shown


def test_studies_and_quantities_of_a_measure_are_words():
    plan = Plan.read(ROOT / "config", "standard")
    named = [
        (name, claim.settings)
        for claims in plan.claims.values()
        for name, claim in claims.items()
        if claim.settings["relative_to"] or claim.settings["minus"]
    ]
    studies = {settings[key] for _, settings in named for key in ("study", "relative_to", "minus")} - {None}
    assert studies <= set(wording.STUDY_PHRASES)
    text = wording.measure_text("least of sticking_r_squared in rough_line over rough_surface, worst of 2 cases")
    assert text == "least of R² while sticking (rough lines over rough surfaces), worst of 2 cases"
    assert wording.measure_text("departure of kappa against kappa_r, worst of 2 cases").startswith("departure of κ")


def test_every_quantity_and_dimension_of_a_claim_has_words_to_read():
    names = {
        *(name for study in PLAN.studies.values() for name in [*quantities(study), *study.dimensions]),
    }
    assert not [name for name in names if "_" in wording.quantity_text(name)]
    assert wording.quantity_text("kappa_r_grid_error") == "grid error of κᵣ"


def test_every_quantity_of_a_work_precision_study_has_a_symbol():
    assert [name for name in MEASURED_QUANTITIES if not RESULTS[name].symbol] == []


def test_the_table_of_claims_shows_symbols_and_says_what_follows_a_value(made):
    rows = pd.read_csv(made / "results/quick/claims/ch3.csv", keep_default_na=False, na_values=["", "nan"])
    rows = rows.astype({"unknown": object}).fillna({"measure": "", "expected": "", "condition": "", "unknown": ""})
    texts = [text.get_text() for text in claims.claims_figure(rows, "Title", "footer").axes[0].texts]
    assert not [text for text in texts if "_" in text]
    assert "slope of aᵣₑₗ against pᵣ*\nalong p*" in texts
    numbers = ("condition_value", "condition_ensemble_error", "condition_grid_error", "condition_share")
    rows.loc[0, ["condition", *numbers]] = ["c/R up to 1", 0.995312, 0.0, 0.00471, 0.75]
    texts = [text.get_text() for text in claims.claims_figure(rows, "Title", "footer").axes[0].texts]
    assert any("0.9953_±_none_±_0.0047".replace("_", "\N{NO-BREAK SPACE}") in text for text in texts)


# --- the sketch of a scene ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("elastic_below", [True, False])
def test_the_elastic_body_is_coloured_and_the_rigid_one_grey(elastic_below):
    elastic, rigid = Body(Flat(8.0), HalfSpace(2.0)), Body(Sinusoid(8.0, 1.0))
    lower, upper = (elastic, rigid) if elastic_below else (rigid, elastic)
    axes = Figure().subplots()
    sketch.plot_sketch(Scene(lower, upper, (HardWall(),), pressures([1.0])), 64, axes)
    middles = [fill.get_paths()[0].get_extents().get_points()[:, 1].mean() for fill in axes.collections]
    assert middles[0] < middles[1]
    for fill, body, text in zip(axes.collections, (lower, upper), axes.texts[:2], strict=True):
        red, green, blue, _ = fill.get_facecolor()[0]
        grey = red == green == blue
        assert grey == (body is rigid)
        assert ("rigid" in text.get_text()) == grey
        assert ("$E^*$ = 2 GPa" in text.get_text()) == (not grey)
        assert fill.get_paths()[0].contains_point(text.get_position())
