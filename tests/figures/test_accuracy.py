"""The figure of accuracy versus cost shows the numbers of its table, its rings and its footer; no text is covered."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest

from contactsim import dataset
from contactsim.evaluation.work_precision import error_cost
from contactsim.evaluation.work_precision.baselines import Baseline, write_baselines
from contactsim.figures import style
from contactsim.figures.diagnostics import accuracy
from contactsim.figures.diagnostics.accuracy_footer import footer_text
from contactsim.figures.layout import empty_figure
from contactsim.study.figure_plan import PICTURE_ENDINGS
from support.prices import LOADS, PATH_REFERENCE, REFERENCE, job, path_job, path_study, study

MARKS = {
    "quick": {"points": 32, "tolerance": 0.1, "members": 2},
    "full": {"points": 1024, "tolerance": 0.1, "members": 3},
    "thesis": {"points": 64, "members": 3},
}
SETTINGS = {
    "title": "Case",
    "caption": "What it shows.",
    "size": [12.0, 6.6],
    "load": LOADS,
    "quantities": ["kappa_r"],
    "settled": {"points": 32, "tolerance": 1e-3},
    "reference": {"points": 1024, "tolerance": 1e-6},
    "levels": {"points": [0.06], "tolerance": [0.05]},
    "repeats": 2,
}
POINTS, TOLERANCES = (16, 32, 64), (1.0, 0.1, 1e-3)
TURNED = [("points", points, 1e-3) for points in POINTS] + [("tolerance", 32, tolerance) for tolerance in TOLERANCES]
JOBS = {
    "reference": REFERENCE,
    "active_set": job(TURNED, [2.2, 2.1, 2.05, 4.8, 4.4, 4.0], [10, 11, 12, 5, 6, 7]),
    "polonsky_keer": job(TURNED[:2] + TURNED[3:5], [2.2, 2.1, 4.8, 4.4], [900, 2000, 70, 90]),
}
SECONDS = {
    "reference": [77.0, 78.0],
    "active_set": [1.0, 2.0, 4.0, 0.3, 0.4, 0.5],
    "polonsky_keer": [10.0, 20.0, 3.0, 5.0],
}
TRANSFORM_SECONDS = 2e-5
PLAN = {
    "settings": SETTINGS,
    "case": "wave",
    "jobs": [*JOBS],
    "kept": {},
    "marks": MARKS,
    "tier": "quick",
    "default": "active_set",
    "selection": {},
    "expected": [["5e3", "1e2"]] * 5 + [["nan", "nan"]],
    "loads": {"reduced_pressure": LOADS},
    "units": {},
    "surface": False,
}
PATH_TURNED = [
    *(("points", points, 1e-3, 0.5) for points in POINTS),
    *(("tolerance", 32, tolerance, 0.5) for tolerance in TOLERANCES),
    *(("increment", 32, 1e-3, increment) for increment in (1.0, 0.5, 0.1)),
]
PATH_JOBS = {
    "reference": PATH_REFERENCE,
    "newton": path_job(PATH_TURNED, [220, 210, 204, 120, 105, 101, 60, 55, 51], [9, 8, 7, 5, 6, 7, 4, 5, 9]),
    "damped_verlet": path_job(PATH_TURNED[6:8], [61.0, 55.0], [900.0, 990.0]),
}
PATH_PLAN = PLAN | {
    "settings": SETTINGS
    | {
        "size": [13.6, 6.6],
        "load": None,
        "quantities": ["pull_off_load_loading"],
        "settled": {"increment": 0.5, "points": 32, "tolerance": 1e-3},  # in the order of JSON
        "reference": {"increment": 0.02, "points": 1024, "tolerance": 1e-6},
        "levels": {"increment": [0.12]},
    },
    "jobs": [*PATH_JOBS],
    "marks": {"quick": {"points": 32}, "full": {"points": 64, "increment": 0.1}, "thesis": {"increment": 0.02}},
    "default": "newton",
    "loads": {},
    "units": {"increment": "nm"},
}


def render(folder, plan=PLAN, jobs=JOBS, members=3, baselines=()):
    """The figure's tables, from small made files."""
    for name, data in jobs.items():
        dataset.write(data, folder / f"{name}.nc")
        costs = {"seconds": SECONDS[name], "transform_seconds": TRANSFORM_SECONDS}
        (folder / f"{name}.json").write_text(json.dumps(costs))
    dataset.write(study(members), folder / "study.nc")
    alone = {"measures_error": False, "member": range(members), "reduced_pressure": 0.1, "seconds": 0.5}
    elsewhere = alone | {"reduced_pressure": 0.5, "seconds": 1e3}
    coarse = alone | {"measures_error": True, "seconds": 1e4}
    rows = pd.concat(map(pd.DataFrame, (alone, elsewhere, coarse)))
    rows.to_csv(folder / "costs.csv", index=False)
    measured = [name for name in plan["jobs"] if name not in plan["kept"]]
    files = {kind: [folder / f"{name}.{end}" for name in measured] for kind, end in (("data", "nc"), ("costs", "json"))}
    files |= {"study": folder / "study.nc", "study_costs": folder / "costs.csv", "baselines": list(baselines)}
    targets = {kind: folder / f"shown.{kind}" for kind in PICTURE_ENDINGS}
    accuracy.write_accuracy(plan, files, targets | {"equal_error": folder / "equal.csv"})
    return pd.read_csv(folder / "shown.csv"), pd.read_csv(folder / "equal.csv")


def drawn(jobs=JOBS, members=3, plan=PLAN):
    """The panels of a case, drawn in full, with seconds a thousandth of the work; the table."""
    settings = plan["settings"]
    ensemble = study(members) if settings["load"] else path_study([200.0] * members)
    table = error_cost.error_table(settings["quantities"], settings["load"], jobs, ensemble, plan["default"])
    table["seconds"] = table.work / 1000
    table = table.assign(predicted_work=np.where(table.own, table.work * 1.5, np.nan))
    table["predicted_seconds"] = table.predicted_work / 1000
    columns = len(accuracy.drawn_knobs(table, settings["quantities"][0])) + 1
    figure, panels = empty_figure(
        settings | {"panels": columns}, "footer", rows=2, widths=[1.0] * (columns - 1) + [1.4]
    )
    axes = np.reshape(panels, (2, columns))
    equal = error_cost.compare_solvers(table, settings["quantities"][0], settings["levels"], accuracy.COSTS)
    accuracy.plot_accuracy(table, equal, jobs[plan["default"]], axes, plan)
    figure.draw_without_rendering()
    return axes, table


@pytest.fixture(scope="module")
def usual():
    """The case as it is; tests leave it as it is."""
    return drawn()


@pytest.fixture(scope="module")
def path():
    """The case of a path as it is."""
    return drawn(PATH_JOBS, 1, PATH_PLAN)


def curve(axes, label):
    (line,) = (line for line in axes.lines if line.get_label() == label)
    return np.array(line.get_data())


def crosses(axes):
    return [place for line in axes.lines if line.get_marker() == "x" for place in zip(*line.get_data(), strict=True)]


def rings(axes):
    return [place for line in axes.lines if line.get_markersize() == 9 for place in zip(*line.get_data(), strict=True)]


@pytest.mark.parametrize(
    "order", [["reference", "active_set", "polonsky_keer"], ["reference", "polonsky_keer", "active_set"]]
)
def test_each_setting_has_the_seconds_that_it_took(tmp_path, order):
    shown, equal = render(tmp_path, PLAN | {"jobs": order})
    for kind, turned in (("active_set", TURNED), ("polonsky_keer", TURNED[:2] + TURNED[3:5])):
        own = shown[(shown.solver == kind) & (shown.knob != "members")]
        assert list(zip(own.knob, own.points, own.tolerance, strict=True)) == turned
        assert own.seconds.tolist() == SECONDS[kind]
    ensembles = shown[shown.knob == "members"]
    assert ensembles.members.tolist() == [2, 3]
    assert ensembles.seconds.tolist() == [1.0, 1.5]  # of the loads priced, without coarser runs
    slow = equal[(equal.solver == "polonsky_keer") & (equal.knob == "points")]
    assert slow.seconds.between(9.9, 10.1).all()


@pytest.mark.parametrize(("row", "measure"), [(0, "work"), (1, "seconds")])
def test_error_is_across_and_cost_is_up(row, measure, usual):
    axes, table = usual
    assert axes[row, 0].get_ylabel() == accuracy.COSTS[measure]
    assert "error" in axes[1, 0].get_xlabel()
    for column, knob in enumerate(("points", "tolerance", "members")):
        for kind in ("active_set", "polonsky_keer") if knob != "members" else ("active_set",):
            own = table[(table.solver == kind) & (table.knob == knob) & (table.kappa_r > 1e-10)]
            assert curve(axes[row, column], style.SOLVER_NAMES[kind]) == pytest.approx(
                own[["kappa_r", measure]].to_numpy().T
            )


def test_the_least_cost_falls_as_the_error_allowed_rises(usual):
    axes, table = usual
    errors, costs = curve(axes[0, 0], "least cost")
    assert (np.diff(errors) < 0).all()
    assert (np.diff(costs) > 0).all()
    assert (errors[0], costs[0]) == pytest.approx((0.1, table.work[0]))
    assert axes[0, 0].lines[0].get_drawstyle() == "steps-pre"  # dearer before, and not after, an error is met


def test_the_values_of_the_tiers_and_of_the_thesis_are_ringed_on_every_curve(usual):
    axes, table = usual
    own = table[table.solver == "active_set"].set_index("knob")
    points, tolerance = own.loc["points"].set_index("points"), own.loc["tolerance"].set_index("tolerance")
    assert np.allclose(rings(axes[0, 0]), points.loc[[32, 64], ["kappa_r", "work"]])
    assert np.allclose(rings(axes[0, 1]), tolerance.loc[[0.1], ["kappa_r", "work"]])
    assert len(rings(axes[0, 2])) == 2
    names = [[text.get_text() for text in panel.texts] for panel in axes[1, :3]]
    assert names == [["thesis", "quick"], ["0", "all tiers"], ["full, thesis", "quick"]]  # the smallest error first


def test_a_setting_that_did_not_converge_is_a_cross_and_has_no_ring():
    jobs = JOBS | {"active_set": JOBS["active_set"].copy(deep=True)}
    jobs["active_set"]["status"][1, 0] = 1
    axes, table = drawn(jobs)
    assert np.allclose(crosses(axes[0, 0]), [(0.05, table.work[1])])
    assert 0.05 not in curve(axes[0, 0], "active set")[0]
    assert "quick" not in [text.get_text() for text in axes[0, 0].texts]
    assert "quick, with grid points 32" in footer_text(table, PLAN)


def test_the_footer_says_where_each_knob_was_turned_its_reference_and_what_has_no_ring(usual):
    text = footer_text(usual[1], PLAN)
    for part in (
        "quick tier · 12 settings, best of up to 2 timings",
        "points varied at tolerance 0.001, reference 1024 points at tolerance 1e-06",
        "tolerance varied at 32 points, reference tolerance 1e-06",
        "members varied at 64 points of the study",
        "without a ring: full, with grid points 1024",
    ):
        assert part in text
    once = PLAN | {"settings": SETTINGS | {"repeats": 1}, "marks": {}}
    assert "each timed once" in footer_text(usual[1], once)
    assert "ring" not in footer_text(usual[1], once)


def test_errors_of_zero_and_infinity_stand_in_margins():
    jobs = JOBS | {"active_set": JOBS["active_set"].copy(deep=True)}
    jobs["active_set"]["kappa_r"][3, 0] = np.nan
    axes, table = drawn(jobs)
    left, right = (patch.get_extents().transformed(axes[0, 1].transData.inverted()) for patch in axes[0, 1].patches)
    ((x, y),) = crosses(axes[0, 1])
    assert right.x0 < x < right.x1
    assert y == table.work[3]
    (zero,) = (line for line in axes[0, 1].lines if line.get_marker() == "o" and line.get_linewidth() == 0)
    assert left.x0 < zero.get_xdata()[0] < left.x1
    assert zero.get_ydata()[0] == table.work[5]
    text = footer_text(table, PLAN)
    assert "without error beyond rounding, at 0: 1" in text
    assert "has no value, at ∞: 1" in text


def test_a_knob_with_a_single_error_has_no_panel_and_the_footer_says_how_large_it_is():
    jobs = JOBS | {"active_set": JOBS["active_set"].copy(deep=True)}
    jobs["active_set"]["kappa_r"][4] = 4.0  # as exact as at the smallest tolerance
    axes, table = drawn(jobs)
    assert [panel.get_title() for panel in axes[0, :-1]] == ["grid points", "members"]
    assert "tolerance has no panel: its error is at most 0.2" in footer_text(table, PLAN)


def test_on_a_surface_its_own_solver_is_the_measure_and_points_are_those_of_a_side():
    jobs = {name: data.assign(points_y=data.points) for name, data in JOBS.items()}
    jobs["conjugate_gradients"] = jobs.pop("active_set")
    axes, table = drawn(jobs, plan=PLAN | {"default": "conjugate_gradients", "surface": True})
    assert axes[0, 0].get_title() == "grid points a side"
    assert axes[0, -1].get_xlabel() == "grid points a side"
    assert "over that of conjugate gradients" in axes[1, -1].texts[0].get_text()
    assert np.allclose(rings(axes[0, 0])[0], table[table.own].iloc[1][["kappa_r", "work"]].astype(float))
    text = footer_text(table, PLAN | {"surface": True})
    assert "reference 1024 × 1024 points at tolerance 1e-06" in text
    assert "curve of conjugate gradients" in text


def test_a_path_has_a_column_for_its_increment_and_shows_its_first_quantity_against_the_grid(path):
    axes, table = path
    assert [panel.get_title() for panel in axes[0]] == ["grid points", "tolerance", "increment (nm)", ""]
    assert axes[1, 2].get_xlabel() == "relative error of pull-off on loading"
    own = table[(table.knob == "increment") & table.own]
    assert own.pull_off_load_loading.to_numpy() == pytest.approx([0.2, 0.1, 0.02])
    assert curve(axes[0, 2], "Newton–Krylov") == pytest.approx(own[["pull_off_load_loading", "work"]].to_numpy().T)
    assert np.allclose(rings(axes[0, 2]), own[["pull_off_load_loading", "work"]].iloc[-1:])
    assert axes[0, 3].get_ylabel() == "pull-off on loading (N/m)"
    assert axes[0, 3].lines[0].get_xydata().tolist() == [[16, 220], [32, 210], [64, 204]]
    assert axes[0, 3].get_legend().get_texts() == []
    assert "Observed order in grid points: pull-off on loading" in axes[1, 3].texts[0].get_text()


def test_the_footer_of_a_path_says_where_three_knobs_were_turned_and_which_tiers_have_no_increment(usual, path):
    text = footer_text(path[1], PATH_PLAN)
    for part in (
        "points varied at tolerance 0.001 and increment 0.5 nm, reference 1024 points at tolerance 1e-06 · tolerance",
        "tolerance varied at 32 points and increment 0.5 nm, reference tolerance 1e-06 · increment",
        "increment varied at 32 points and tolerance 0.001, reference increment 0.02 nm",
        "without a ring: thesis, with increment 0.02 nm",
        "increments of their own, so without a ring: quick",
    ):
        assert part in text
    assert "adapt" not in footer_text(usual[1], PLAN)


@pytest.mark.parametrize(
    ("work", "seconds", "text"),
    [
        (138.2, 62.9, "140 (63)"),
        (3.0, 0.687, "3.0 (0.69)"),
        (99.6, 9.96, "100 (10)"),
        (2640.0, 0.054, "2600 (0.054)"),
        (np.nan, 1.0, "–"),
    ],
)
def test_ratios_have_two_digits_and_no_powers_of_ten(work, seconds, text):
    assert accuracy.cost_text(pd.Series({"work": work, "seconds": seconds})) == text


def test_the_forecast_counts_in_the_unit_of_time_of_the_machine_that_measured(tmp_path):
    table, _ = render(tmp_path)
    own = table[(table.solver == "active_set") & (table.knob != "members")]
    assert own.predicted_work.tolist()[:5] == [5e3] * 5
    assert own.predicted_seconds[:5].to_numpy() == pytest.approx([1e2 * TRANSFORM_SECONDS] * 5)
    assert table.predicted_work.isna().sum() == len(table) - 5


@pytest.mark.parametrize("slower", [1.0, 4.0])
def test_kept_baselines_are_shown_as_if_measured_with_their_seconds_scaled(tmp_path, slower):
    kept = Baseline(
        *("wave", "polonsky_keer", "digest", "2000-12-31", TRANSFORM_SECONDS * slower),
        [seconds * slower for seconds in SECONDS["polonsky_keer"]],
        JOBS["polonsky_keer"],
    )
    write_baselines([kept], tmp_path / "package/baselines.csv")
    jobs = {name: data for name, data in JOBS.items() if name != "polonsky_keer"}
    plan = PLAN | {"kept": {"polonsky_keer": kept.measured}}
    tables = render(tmp_path, plan, jobs, baselines=[tmp_path / "package/baselines.csv"])
    for shown, measured in zip(tables, render(tmp_path), strict=True):
        pd.testing.assert_frame_equal(shown.drop(columns="seconds"), measured.drop(columns="seconds"), check_exact=True)
        assert shown.seconds.to_numpy() == pytest.approx(measured.seconds.to_numpy(), nan_ok=True)


def test_the_footer_says_which_baselines_are_kept_and_that_their_seconds_are_scaled(usual):
    text = footer_text(usual[1], PLAN | {"kept": {"polonsky_keer": "2000-12-31"}})
    assert "baselines (Polonsky–Keer) are kept in the package, measured on 2000-12-31" in text
    assert "their seconds are scaled by the time of a transform" in text
    assert "kept" not in footer_text(usual[1], PLAN)
