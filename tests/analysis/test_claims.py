"""Verdicts follow from the data: every category, every reduction, every refusal."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from contactsim import dataset, reference
from contactsim.analysis import aggregate, claims, reductions
from contactsim.analysis.claims import CONDITION, NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED
from contactsim.analysis.uncertainty import Estimate, estimate
from contactsim.errors import InputError
from contactsim.figures.diagnostics.claims import COLOURS, claims_figure
from contactsim.study.claim_plan import Claim, read_claim
from contactsim.study.plan import Plan
from support.places import ROOT

PLAN = Plan.read(ROOT / "config", "quick")
STUDIES = {
    name: PLAN.studies[name]
    for name in ("smooth_line", "rough_line", "rough_line_coarse", "rough_surface", "surface_resolution")
}
PRESSURES = [0.001, 0.01, 0.1]
VALUE = {
    "source": "Section 0",
    "statement": "κ is 2.",
    "rationale": "A test.",
    "study": "rough_line",
    "quantity": "kappa",
    "reduce": "mean",
    "expect": 2.0,
    "tolerance": 0.1,
}


def claim(**changes):
    """The settings of a claim as read, with some changed; None leaves a key out."""
    section = {key: value for key, value in (VALUE | changes).items() if value is not None}
    return read_claim("test", section, "ch3.yaml", STUDIES).settings


def made_up(level=2.0, scatter=0.0, grid=0.0, tilt=0.0, members=4, points=262144):
    """A dataset of rough lines: κ of a level, a scatter over members, a grid error and a slope in log p*."""
    offsets = scatter * np.linspace(-1, 1, members) if members > 1 else np.zeros(1)
    kappa = level + tilt * np.log10(np.array(PRESSURES) / 0.01) + np.zeros((2, 1, 1)) + offsets[:, None]
    dims = ("hurst_exponent", "member", "reduced_pressure")
    values = {
        "kappa": (dims, kappa),
        "relative_contact_area": (dims, kappa * PRESSURES),
        "status": (dims, np.zeros(kappa.shape, np.int8)),
        "kappa_grid_error": (("hurst_exponent", "reduced_pressure"), np.full((2, 3), grid)),
        "relative_contact_area_grid_error": (("hurst_exponent", "reduced_pressure"), grid * np.tile(PRESSURES, (2, 1))),
        "points": points,
    }
    places = {"hurst_exponent": [0.2, 0.8], "member": range(members), "reduced_pressure": PRESSURES}
    settings = {"surface": {"kind": "self_affine"}, "thesis_points": 262144}
    return xr.Dataset(values, places, {"problem": "hard_wall", "settings": json.dumps(settings)})


# --- verdicts -----------------------------------------------------------------------------------------------------


def test_a_verdict_flips_when_the_dataset_changes():
    assert claims.judge(claim(), [made_up(2.05)])["verdict"] == REPRODUCED
    assert claims.judge(claim(), [made_up(2.15)])["verdict"] == NOT_REPRODUCED


@pytest.mark.parametrize("level", [2.05, 2.15])
@pytest.mark.parametrize(("scatter", "grid"), [(0.0, 0.06), (0.2, 0.0), (0.1, 0.04)])
def test_an_error_larger_than_the_distance_to_the_edge_leaves_it_open(level, scatter, grid):
    assert claims.judge(claim(), [made_up(level, scatter, grid)])["verdict"] == NOT_DECIDABLE
    assert claims.judge(claim(), [made_up(level, scatter / 9, grid / 9)])["verdict"] != NOT_DECIDABLE


def test_the_two_errors_add_in_quadrature():
    settings = claim()
    assert claims.verdict(settings, Estimate(2.05, 0.03, 0.039)) == REPRODUCED
    assert claims.verdict(settings, Estimate(2.05, 0.03, 0.041)) == NOT_DECIDABLE


def test_the_grid_error_of_a_ratio_is_the_worst_of_moving_apart_and_moving_down():
    part = claim(quantity="relative_contact_area", against="kappa", reduce="ratio", expect=0.1, tolerance=0.05)
    result = estimate(part, [made_up(2.0, grid=0.2)])
    assert result.grid_error == pytest.approx(0.1 * (1.1 / 0.9 - 1))  # the area up, κ down
    data = made_up(2.0).assign(kappa_grid_error=made_up(grid=0.2).kappa_grid_error)
    assert estimate(part, [data]).grid_error == pytest.approx(0.1 * (1 / 0.9 - 1))  # κ down


def on_grids(errors, members=3):
    """A dataset of surfaces on three grids: κ_r at 1.9 and, of each grid, an error; a scatter over members."""
    dims = ("points", "hurst_exponent", "member", "reduced_pressure")
    level = 1.9 + 0.001 * np.linspace(-1, 1, members)
    values = np.reshape(errors, (3, 1, 1, -1)) + level[:, None] + np.zeros((3, 2, members, 3))
    data = xr.Dataset(
        {"kappa_r": (dims, values), "status": (dims, np.zeros(values.shape, np.int8))},
        {
            "points": [1024, 2048, 4096],
            "hurst_exponent": [0.2, 0.8],
            "member": range(members),
            "reduced_pressure": PRESSURES,
        },
        {"problem": "hard_wall", "settings": json.dumps({"surface": {"kind": "self_affine"}})},
    )
    return data.merge(aggregate.finer_grid_limits(data))


def limit_claim(value):
    """The settings of a claim on the limit of κ_r on finer grids."""
    return claim(study="surface_resolution", quantity="kappa_r_limit", expect=value, tolerance=0.02)


def test_a_limit_on_finer_grids_has_the_distance_from_that_of_first_order_as_its_error():
    settings = limit_claim(1.88)
    first = estimate(settings, [on_grids([0.4, 0.2, 0.1])])
    assert (first.value, first.grid_error) == pytest.approx((1.9, 0.0), abs=1e-12)
    assert first.ensemble_error == pytest.approx(0.001 / np.sqrt(3), rel=1e-6)
    second = estimate(settings, [on_grids([0.32, 0.08, 0.02])])  # first order would end at 1.86
    assert (second.value, second.grid_error) == pytest.approx((1.9, 0.04), rel=1e-9)
    assert claims.judge(settings, [on_grids([0.32, 0.08, 0.02])])["verdict"] == NOT_DECIDABLE
    far = limit_claim(1.7)
    assert claims.judge(far, [on_grids([0.32, 0.08, 0.02])])["verdict"] == NOT_REPRODUCED
    assert claims.judge(far, [on_grids([0.32, 0.08, 0.02], members=1)])["verdict"] == NOT_DECIDABLE


def test_where_one_mean_has_no_limit_the_claim_is_not_decidable():
    settings = limit_claim(1.5)
    turning = on_grids([[0.4, 0.4, 0.1], [0.2, 0.2, 0.2], [0.1, 0.1, 0.1]])  # at the largest load it turns round
    assert claims.judge(settings, [turning])["verdict"] == NOT_DECIDABLE


def test_a_relation_has_one_edge():
    most, least = claim(expect=None, tolerance=None, at_most=3.0), claim(expect=None, tolerance=None, at_least=3.0)
    assert [claims.judge(most, [made_up(level)])["verdict"] for level in (2.0, 4.0)] == [REPRODUCED, NOT_REPRODUCED]
    assert [claims.judge(least, [made_up(level)])["verdict"] for level in (2.0, 4.0)] == [NOT_REPRODUCED, REPRODUCED]
    assert (claims.band_text(most), claims.band_text(least), claims.band_text(claim())) == ("≤ 3", "≥ 3", "2 ± 0.1")


def test_a_condition_that_holds_is_named_and_one_that_does_not_changes_nothing():
    low = claim(condition={"description": "at low p*", "select": {"reduced_pressure": [0.001, 0.005]}})
    high = claim(condition={"description": "at high p*", "select": {"reduced_pressure": [0.05, 0.1]}})
    data = made_up(2.5, tilt=0.5)  # 2, 2.5 and 3 at the three loads
    row = claims.judge(low, [data])
    assert (row["verdict"], row["condition"]) == (CONDITION, "at low p*")
    assert (row["value"], row["condition_value"]) == pytest.approx((2.5, 2.0))
    row = claims.judge(high, [data])
    assert (row["verdict"], row["condition"]) == (NOT_REPRODUCED, "")
    assert np.isnan(row["condition_value"])


def test_where_a_condition_decides_against_an_open_statement_it_is_not_reproduced():
    settings = claim(condition={"description": "on the grid of the thesis", "grid": "thesis"})
    row = claims.judge(settings, [made_up(3.0, grid=5.0)])
    assert (row["verdict"], row["condition"]) == (NOT_REPRODUCED, "on the grid of the thesis")
    assert row["condition_value"] == pytest.approx(3.0)


def test_a_condition_is_not_needed_where_all_is_reproduced():
    row = claims.judge(claim(condition={"description": "at low p*", "select": {}}), [made_up()])
    assert (row["verdict"], row["condition"]) == (REPRODUCED, "")


def test_on_the_grid_of_the_thesis_its_numbers_are_compared_without_grid_error():
    settings = claim(condition={"description": "on the grid of the thesis", "grid": "thesis"})
    assert claims.judge(settings, [made_up(grid=0.5)])["verdict"] == CONDITION
    assert claims.judge(settings, [made_up(grid=0.5, points=1024)])["verdict"] == NOT_DECIDABLE


def test_a_statement_about_the_grid_of_the_thesis_is_open_on_another():
    settings = claim(
        quantity="kappa_grid_error", against="kappa", reduce="ratio", expect=0.05, tolerance=0.02, grid="thesis"
    )
    assert claims.judge(settings, [made_up(grid=0.1)])["verdict"] == REPRODUCED
    assert claims.judge(settings, [made_up(grid=0.1, points=1024)])["verdict"] == NOT_DECIDABLE


def test_a_claim_without_data_is_not_decidable():
    bare = read_claim("test", {key: VALUE[key] for key in ("source", "statement", "rationale")}, "ch3.yaml", STUDIES)
    assert claims.judge(bare.settings, [])["verdict"] == NOT_DECIDABLE
    assert (claims.band_text(bare.settings), claims.comparison_text(bare.settings)) == ("", "")
    nowhere = claim(select={"reduced_pressure": [0.5, 1.0]})
    assert claims.judge(nowhere, [made_up()])["verdict"] == NOT_DECIDABLE


def test_unconverged_solutions_do_not_count_and_with_none_left_it_is_open():
    data = made_up()
    data["kappa"][:, 0] = 99.0
    data["status"][:, 0] = 1
    assert estimate(claim(), [data]).value == pytest.approx(2.0)
    data["status"][:] = 1
    assert claims.judge(claim(), [data])["verdict"] == NOT_DECIDABLE


def test_one_member_of_a_random_surface_has_no_known_error_and_a_cylinder_needs_none():
    alone = made_up(members=1)
    assert claims.judge(claim(), [alone])["verdict"] == NOT_DECIDABLE
    alone.attrs["settings"] = json.dumps({"surface": {"kind": "cylinder"}, "thesis_points": None})
    assert claims.judge(claim(), [alone])["verdict"] == REPRODUCED


def test_without_a_coarse_run_the_grid_error_is_unknown():
    assert claims.judge(claim(), [made_up().drop_vars("kappa_grid_error")])["verdict"] == NOT_DECIDABLE


# --- ratios of two studies ----------------------------------------------------------------------------------------

RATIO = {"relative_to": "rough_surface", "expect": 0.9, "tolerance": 0.05}


def test_over_a_second_study_the_number_is_the_ratio_of_the_means():
    two = [made_up(1.8, scatter=0.1), made_up(2.0, scatter=0.3, members=7)]
    found = estimate(claim(**RATIO), two)
    assert found.value == pytest.approx(0.9)
    swapped = estimate(claim(**RATIO), two[::-1])
    assert swapped.value == pytest.approx(1 / 0.9)
    assert claims.judge(claim(**RATIO), [made_up(1.8), made_up(2.0)])["verdict"] == REPRODUCED
    assert claims.judge(claim(**RATIO), [made_up(1.8), made_up(1.8)])["verdict"] == NOT_REPRODUCED


def test_a_ratio_is_taken_where_both_studies_have_loads_and_variants():
    lines = made_up(1.8, tilt=0.3)  # κ of 1.5, 1.8 and 2.1
    surfaces = made_up(2.0).isel(reduced_pressure=[0, 2], hurst_exponent=[1])
    found = estimate(claim(**RATIO), [lines, surfaces.assign_coords(reduced_pressure=[0.001, 0.2])])
    assert found.value == pytest.approx(0.75)  # the first load alone
    apart = surfaces.assign_coords(reduced_pressure=[0.002, 0.2])
    assert claims.judge(claim(**RATIO), [lines, apart])["verdict"] == NOT_DECIDABLE
    below = {"reduced_pressure": [0.05, 0.1]}
    assert estimate(claim(**RATIO, select=below), [lines, surfaces]).value == pytest.approx(2.1 / 2)


def test_the_ensembles_of_a_ratio_are_independent():
    one, two = made_up(1.8, scatter=0.02, members=4), made_up(2.0, scatter=0.05, members=9)
    relative = [estimate(claim(), [data]).ensemble_error / level for data, level in ((one, 1.8), (two, 2.0))]
    found = estimate(claim(**RATIO), [one, two])
    assert found.ensemble_error == pytest.approx(0.9 * np.hypot(*relative), rel=1e-3)
    alone = estimate(claim(**RATIO), [one, made_up(2.0, members=1)])
    assert np.isnan(alone.ensemble_error)


def test_the_grid_errors_of_a_ratio_move_apart_and_one_that_is_unknown_leaves_it_open():
    one, two = made_up(1.8, grid=0.09), made_up(2.0, grid=0.2)
    assert estimate(claim(**RATIO), [one, two]).grid_error == pytest.approx(0.9 * (1.05 / 0.9 - 1))
    unknown = two.drop_vars("kappa_grid_error")
    assert claims.judge(claim(**RATIO), [made_up(1.8), unknown])["verdict"] == NOT_DECIDABLE


def test_the_grid_of_the_thesis_is_that_of_both_studies():
    settings = claim(**RATIO, condition={"description": "on the grid of the thesis", "grid": "thesis"})
    assert claims.judge(settings, [made_up(1.8, grid=0.5), made_up(2.0)])["verdict"] == CONDITION
    assert claims.judge(settings, [made_up(1.8, grid=0.5), made_up(2.0, points=1024)])["verdict"] == NOT_DECIDABLE


def test_a_ratio_names_both_studies_and_asks_for_both():
    assert claims.comparison_text(claim(**RATIO)) == "mean of kappa in rough_line over rough_surface"
    assert Claim("test", claim(**RATIO)).studies == ["rough_line", "rough_surface"]
    data = {"rough_line": made_up(1.8), "rough_surface": made_up(2.0)}
    row = claims.judge_claims({"test": claim(**RATIO)}, data).iloc[0]
    assert (row.value, row.study, row.relative_to) == (pytest.approx(0.9), "rough_line", "rough_surface")


# --- paths --------------------------------------------------------------------------------------------------------

PATHS = {name: PLAN.studies[name] for name in ("indentation", "indentation_uncoupled", "pull_off")}
PULL = VALUE | {"study": "indentation", "quantity": "pull_off_load_loading", "expect": 15.0, "tolerance": 1.0}


def path_claim(**changes):
    section = {key: value for key, value in (PULL | changes).items() if value is not None}
    return read_claim("test", section, "ch4.yaml", PATHS).settings


def paths(values, grid=0.0, increment=None, **places):
    """A dataset of one path for each place, with a pull-off, its errors, and fields of a grid of its own."""
    values = np.asarray(values, float)
    variables = {
        "pull_off_load_loading": ((*places, "member"), values[..., None]),
        "pull_off_load_loading_grid_error": (tuple(places), np.full(values.shape, grid)),
        "status": ((*places, "member", "step"), np.zeros((*values.shape, 1, 5), np.int8)),
        "heights": ("x", np.zeros(int(values.size))),
    }
    if increment is not None:
        variables["pull_off_load_loading_increment_error"] = (
            (*places, "member"),
            np.full((*values.shape, 1), increment),
        )
    settings = {"surface": {"kind": "cylinder"}, "thesis_points": 2048}
    coordinates = places | {"x": np.linspace(0, 1, values.size)}
    return xr.Dataset(variables, coordinates, {"problem": "hard_wall", "settings": json.dumps(settings)})


WORKS, RATIOS = [1.0, 2.0], [0.0, 0.5, 1.0]
GRID = paths([[10.0, 12.0, 11.0], [20.0, 21.0, 30.0]], work_of_separation=WORKS, work_ratio=RATIOS)
FOUND = {
    "rise": ({"along": "work_ratio"}, (0.1 + 0.5) / 2),
    "least_rise": ({"along": "work_ratio"}, 0.1),
    "largest_rise": ({"along": "work_ratio"}, 0.5),
    "rise_gain": ({"along": "work_ratio", "across": "work_of_separation"}, 0.4),
    "shortfall": ({"along": "work_ratio"}, (1 / 11 + 1 / 3) / 2),
    "largest_spread": ({"along": "work_ratio"}, 10 / (71 / 3)),
    "least": ({}, 10.0),
    "largest": ({}, 30.0),
    "mean": ({}, 104 / 6),
    "slope": ({"along": "work_of_separation", "against": "work_of_separation"}, np.log2([2, 21 / 12, 30 / 11]).mean()),
}


@pytest.mark.parametrize(
    ("reduction", "uses", "value"), [(name, *expected) for name, expected in FOUND.items()], ids=FOUND
)
def test_each_reduction_of_paths_equals_a_calculation_by_hand(reduction, uses, value):
    assert estimate(path_claim(reduce=reduction, **uses), [GRID]).value == pytest.approx(value)


def test_a_spread_of_negative_numbers_is_positive():
    along = {"reduce": "largest_spread", "along": "work_ratio"}
    assert estimate(path_claim(**along), [GRID.assign(pull_off_load_loading=-GRID.pull_off_load_loading)]).value > 0


def test_a_ratio_of_two_studies_is_taken_at_each_value_that_one_of_them_varies():
    uncoupled = paths([[5.0, 4.0], [10.0, 8.0]], poisson_ratio=[0.1, 0.3], work_of_separation=[2.0, 3.0])
    over = {"relative_to": "indentation_uncoupled", "reduce": "largest"}
    assert estimate(path_claim(**over), [GRID, uncoupled]).value == pytest.approx(30 / 5)
    one = path_claim(**over, select={"poisson_ratio": [0.3, 0.3], "work_ratio": [0.0, 0.0]})
    assert estimate(one, [GRID, uncoupled]).value == pytest.approx(20 / 10)


def test_a_path_has_no_ensemble_error_and_its_increments_count_with_its_grid():
    found = estimate(path_claim(), [GRID])
    assert (found.ensemble_error, found.grid_error) == (0.0, 0.0)
    data = paths([[10.0, 20.0]], grid=0.2, increment=0.3, work_of_separation=[1.0], work_ratio=[0.0, 1.0])
    assert estimate(path_claim(), [data]).grid_error == pytest.approx(0.5)


# --- numbers ------------------------------------------------------------------------------------------------------


def array(values, **places):
    return xr.DataArray(values, places, dims=tuple(places))


def test_each_reduction_equals_a_calculation_by_hand():
    load = array([1.0, 10.0, 100.0], load=[1, 2, 3])
    both = array([[2.0, 4.0, 3.0], [1.0, 1.0, 1.0]], hurst_exponent=[0.2, 0.8], load=[1, 2, 3])
    assert reductions.mean(both) == 2.0
    assert reductions.spread(both, "load") == pytest.approx((2 / 3 + 0) / 2)
    assert reductions.spread(both, "hurst_exponent") == pytest.approx((1 / 1.5 + 3 / 2.5 + 2 / 2) / 3)
    assert reductions.fall(both, "load") == pytest.approx((-0.5 + 0) / 2)
    assert reductions.slope(load**0.5, load, "load") == pytest.approx(0.5)
    assert reductions.spread_ratio(both, 2 * both, "load") == 1.0
    assert reductions.departure(both, array([2.0, 2.0, 2.0], load=[1, 2, 3])) == 1.0
    assert reductions.ratio(both, load) == 2.0


def test_the_ensemble_error_of_a_mean_is_the_stored_standard_error_and_so_is_the_grid_error(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    settings = claim(select={"hurst_exponent": [0.5, 0.5], "reduced_pressure": [0.1, 0.1]})
    found, at = estimate(settings, [data]), data.sel(hurst_exponent=0.5, reduced_pressure=0.1)
    assert found.value == pytest.approx(float(at.kappa_mean))
    assert found.ensemble_error == pytest.approx(float(at.kappa_standard_error))
    assert found.grid_error == pytest.approx(float(at.kappa_grid_error))


def test_the_fits_are_those_of_the_dataset(made):
    data = dataset.load_dataset(made / "results/quick/datasets/ch3_rough_line.nc")
    below = data.sel(reduced_pressure=slice(0, 0.1001))
    pressure = below.reduced_pressure.values
    for name, weighting, fitted in (
        ("kappa_fit", "area", ["0.2", "0.5", "0.8"]),
        ("kappa_fit_logarithm", "logarithm", ["0.2", "0.5", "0.8"]),
        ("kappa_fit_all", "area", ["all"] * 3),
    ):
        found = reductions.mean_quantity(below, name)
        for row, which in zip(found.values, fitted, strict=True):
            fit = data.sel(weighting=weighting, fit_limit=0.1, fitted=which)
            expected = reference.line_area(pressure, float(fit.fit_b1), float(fit.fit_b2)) / pressure
            assert np.allclose(row, expected)


# --- the claims of this project -----------------------------------------------------------------------------------


UNANSWERED = {
    "ch3": ["neglected_effort", "height_density", "fit_scaraggi"],
    "ch4": ["neglected_experiments"],
    "ch5": ["error_bars", "error_bars_larger"],
    "ch6": [],
}

LACKING = {
    "ch3": ["surface_kappa_limit", "surface_kappa_r_limit"],
    "ch4": ["compressible_curves_weak"],
    "ch5": [],
    "ch6": ["smooth_stiff"],
}
"""Claims on members, for the error of a limit, and on works of separation that the quick tier leaves out."""


@pytest.mark.parametrize(("chapter", "unanswered"), UNANSWERED.items())
def test_every_claim_of_the_config_is_judged(made, chapter, unanswered):
    assert set(UNANSWERED) == set(PLAN.claims)
    folder = made / "results/quick/claims"
    rows = pd.read_csv(folder / f"{chapter}.csv", keep_default_na=False, na_values=["", "nan"])
    assert rows.claim.tolist() == list(PLAN.claims[chapter])
    assert rows.verdict.isin(COLOURS).all()
    answered = rows.study.notna()
    assert rows.claim[~answered].tolist() == unanswered
    known = np.isfinite(rows[["value", "ensemble_error"]]).all(axis=1)
    assert rows.claim[answered & ~known].tolist() == LACKING[chapter]
    assert (rows.verdict[answered & ~known] == NOT_DECIDABLE).all()
    assert (rows.verdict[~answered] == NOT_DECIDABLE).all()


def test_the_table_shows_every_claim_in_the_colour_of_its_verdict():
    names = {verdict: Claim("x", claim()) for verdict in COLOURS}
    rows = claims.judge_claims({name: one.settings for name, one in names.items()}, {"rough_line": made_up()})
    rows["verdict"] = list(COLOURS)
    rows["condition"] = ["", "somewhere " * 9, "", ""]
    axes = claims_figure(rows, "Title", "footer " * 80).axes[0]
    shown = [text.get_text() for text in axes.texts]
    assert set(rows.statement) <= {text.replace("\n", " ") for text in shown}
    assert any("somewhere" in text and "\n" in text for text in shown)
    assert len({tuple(band.get_facecolor()[0]) for band in axes.collections}) == len(COLOURS) + 1


def test_verdicts_depend_on_claims_code_and_every_study_asked():
    settings = PLAN.claims_settings("ch3")
    studies = {entry[key] for _, entry in settings["claims"] for key in ("study", "relative_to")}
    assert set(settings["data"]) == studies - {None}
    assert settings["data"] != Plan.read(ROOT / "config", "full").claims_settings("ch3")["data"]
    assert not any("verdict" in one for _, one in settings["claims"])


def test_a_chapter_without_claims_is_not_judged(tmp_path):
    for file in (ROOT / "config").glob("*.yaml"):
        (tmp_path / file.name).write_text(file.read_text(encoding="utf-8").split("\nclaims:")[0], encoding="utf-8")
    assert Plan.read(tmp_path).claims == {}


# --- refusals -----------------------------------------------------------------------------------------------------

BOTH = "hurst_exponent, reduced_pressure"
BAD = [
    # changes, key, value, words of what is allowed
    ({"verdict": "reproduced"}, "verdict", "reproduced", "no such key"),
    ({"rationale": None}, "rationale", "nothing", "why that band"),
    ({"study": "rough"}, "study", "rough", "smooth_line, rough_line"),
    ({"reduce": "guess"}, "reduce", "guess", "mean, spread, fall"),
    ({"reduce": None}, "reduce", None, "mean, spread, fall"),
    ({"quantity": "kapa"}, "quantity", "kapa", "kappa, kappa_fit"),
    ({"quantity": None}, "quantity", None, "kappa, kappa_fit"),
    ({"quantity": "half_width"}, "quantity", "half_width", "kappa"),
    ({"quantity": "kappa_r_limit"}, "quantity", "kappa_r_limit", "kappa"),  # on one grid
    ({"reduce": "spread", "along": "speed"}, "along", "speed", BOTH),
    ({"reduce": "spread"}, "along", None, BOTH),
    ({"along": "hurst_exponent"}, "along", "hurst_exponent", "mean does not use it"),
    ({"reduce": "ratio", "against": "area"}, "against", "area", "relative_contact_area"),
    ({"relative_to": "rough"}, "relative_to", "rough", "rough_line_coarse, rough_surface"),
    ({"relative_to": "rough_line"}, "relative_to", "rough_line", "rough_line_coarse, rough_surface"),
    ({"relative_to": "smooth_line"}, "relative_to", "smooth_line", "rough_surface"),
    ({"relative_to": "rough_surface", "quantity": "half_width"}, "quantity", "half_width", "kappa, kappa_fit"),
    (
        {"relative_to": "rough_surface", "reduce": "ratio", "against": "kappa_r"},
        "reduce",
        "ratio",
        "mean, spread, fall",
    ),
    ({"select": {"contact_ratio": [0.1, 0.2]}}, "select.contact_ratio", [0.1, 0.2], BOTH),
    ({"select": {"hurst_exponent": [0.5, 0.1]}}, "select.hurst_exponent", [0.5, 0.1], "least and largest"),
    ({"tolerance": None}, None, ["expect"], "expect with tolerance"),
    ({"at_most": 3.0}, None, ["at_most", "expect", "tolerance"], "expect with tolerance"),
    ({"tolerance": 0.0}, "tolerance", 0.0, "a positive number"),
    ({"condition": {"grid": "thesis"}}, "condition.description", "nothing", "in words"),
    ({"condition": {"description": "", "grid": "ours"}}, "condition.grid", "ours", "thesis"),
    ({"study": None, "quantity": None, "reduce": None}, "expect", 2.0, "left out"),  # no data, no expectation
]


@pytest.mark.parametrize(("changes", "key", "value", "allowed"), BAD)
def test_a_bad_claim_is_refused_with_file_key_value_and_what_is_allowed(changes, key, value, allowed):
    with pytest.raises(InputError) as caught:
        claim(**changes)
    error = caught.value
    assert (error.file, error.value) == ("ch3.yaml", value)
    assert error.key == (f"claims.test.{key}" if key else "claims.test")
    assert allowed in error.allowed


def test_the_plan_refuses_a_bad_claim(tmp_path):
    for file in (ROOT / "config").glob("*.yaml"):
        text = file.read_text(encoding="utf-8")
        (tmp_path / file.name).write_text(text.replace("    reduce: fall\n", "    reduce: sink\n", 1), encoding="utf-8")
    with pytest.raises(
        InputError, match=r"ch3.yaml: claims.kappa_not_constant.reduce: got 'sink'; allowed: one of mean"
    ):
        Plan.read(tmp_path)
