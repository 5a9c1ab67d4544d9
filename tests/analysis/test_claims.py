"""Verdicts follow from the data: every category, its margin, its condition, every refusal."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from contactsim.analysis import claims
from contactsim.analysis.claims import judge
from contactsim.analysis.comparison import SECOND_STUDY, Comparison
from contactsim.analysis.conditions import narrower_blocks
from contactsim.analysis.quantities import FITTED, mean_quantity, with_quantities
from contactsim.analysis.reductions import ORDERS, REDUCTIONS
from contactsim.analysis.uncertainty import Estimate, estimate
from contactsim.analysis.verdict import (
    CONDITION,
    FINDING,
    NOT_DECIDABLE,
    NOT_REPRODUCED,
    REPRODUCED,
    judge_number,
    judge_steps,
)
from contactsim.errors import InputError
from contactsim.figures.diagnostics.claims import COLOURS, claims_figure
from contactsim.reference.hard_wall import line_area
from contactsim.status import Status
from contactsim.study.claim_plan import Claim, read_claim
from contactsim.study.plan import Plan
from support.claims import BANDLESS, PLAN, PRESSURES, STUDIES, VALUE, claim, made_up, path_claim, paths, with_corrected
from support.places import ROOT

RATIO = {"relative_to": "rough_surface", "expect": 0.9, "tolerance": 0.05}

# --- verdicts -----------------------------------------------------------------------------------------------------


def test_a_verdict_flips_when_the_dataset_changes():
    assert judge(claim(), [made_up(2.05, grid=0.01)])["verdict"] == REPRODUCED
    assert judge(claim(), [made_up(2.15, grid=0.01)])["verdict"] == NOT_REPRODUCED


@pytest.mark.parametrize("level", [2.05, 2.15])
@pytest.mark.parametrize(("scatter", "grid"), [(0.0, 0.03), (0.12, 0.0), (0.06, 0.02)])
def test_within_two_errors_of_the_edge_a_claim_is_not_decidable(level, scatter, grid):
    assert judge(claim(), [made_up(level, scatter, grid)])["verdict"] == NOT_DECIDABLE
    assert judge(claim(), [made_up(level, scatter / 9, grid / 9)])["verdict"] != NOT_DECIDABLE


@pytest.mark.parametrize(
    ("number", "verdict", "margin", "place"),
    [
        (Estimate(2.05, 0.0, 0.01), REPRODUCED, 5.0, 0.5),
        (Estimate(1.98, 0.0, 0.04), REPRODUCED, 2.0, 0.2),
        (Estimate(2.05, 0.015, 0.02), REPRODUCED, 2.0, 0.5),  # errors in quadrature
        (Estimate(2.05, 0.015, 0.021), NOT_DECIDABLE, 0.05 / np.hypot(0.015, 0.021), 0.5),
        (Estimate(2.2, 0.0, 0.05), NOT_REPRODUCED, 2.0, 2.0),
        (Estimate(2.0, 0.0, 0.0), REPRODUCED, np.inf, 0.0),
        (Estimate(2.05, np.nan, 0.01), NOT_DECIDABLE, np.nan, np.nan),
        (Estimate(), NOT_DECIDABLE, np.nan, np.nan),
    ],
)
def test_a_number_has_a_verdict_a_margin_in_errors_and_a_place_in_the_band(number, verdict, margin, place):
    result = judge_number(claim(), number)
    assert result.verdict == verdict
    assert [result.margin, result.place] == pytest.approx([margin, place], nan_ok=True)


@pytest.mark.parametrize(("value", "verdict"), [(0.0, NOT_REPRODUCED), (1e-9, REPRODUCED), (-1e-9, NOT_REPRODUCED)])
def test_a_number_known_to_be_zero_does_not_have_the_sign_that_a_statement_claims(value, verdict):
    result = judge_number(claim(**BANDLESS, at_least=0.0, neutral=0.0), Estimate(value, 0.0, 0.0))
    assert (result.verdict, result.margin) == (verdict, np.inf)


def test_a_case_may_have_a_band_of_its_own():
    cases = {
        "another number": {"expect": 3.0},
        "one edge": {"at_least": 1.5},
    }
    settings = claim(case="a number", cases=cases)["cases"]
    assert (settings["another number"]["expect"], settings["another number"]["tolerance"]) == (
        3.0,
        claim()["tolerance"],
    )
    assert (settings["one edge"]["expect"], settings["one edge"]["at_least"]) == (None, 1.5)


def test_a_relation_has_one_edge():
    most, least = claim(**BANDLESS, at_most=3.0), claim(**BANDLESS, at_least=3.0)
    assert [judge(most, [made_up(level)])["verdict"] for level in (2.0, 4.0)] == [REPRODUCED, NOT_REPRODUCED]
    assert [judge(least, [made_up(level)])["verdict"] for level in (2.0, 4.0)] == [NOT_REPRODUCED, REPRODUCED]
    assert (claims.band_text(most), claims.band_text(least), claims.band_text(claim())) == ("≤ 3", "≥ 3", "2 ± 0.1")


@pytest.mark.parametrize(
    ("changes", "value", "half", "double"),
    [
        ({}, 2.07, NOT_REPRODUCED, REPRODUCED),
        ({}, 2.15, NOT_REPRODUCED, REPRODUCED),
        (BANDLESS | {"at_most": 3.0, "neutral": 1.0}, 2.5, NOT_REPRODUCED, REPRODUCED),
        (BANDLESS | {"at_least": 0.9, "neutral": 1.0}, 0.85, NOT_REPRODUCED, REPRODUCED),
        (BANDLESS | {"at_most": 3.0}, 2.5, REPRODUCED, REPRODUCED),  # no neutral value: no width to scale
    ],
)
def test_bands_are_halved_and_doubled_about_the_neutral_value(changes, value, half, double):
    settings, number = claim(**changes), Estimate(value, 0.0, 0.001)
    assert judge_number(settings, number, 0.5).verdict == half
    assert judge_number(settings, number, 2.0).verdict == double


def test_a_row_has_the_verdicts_with_half_and_double_bands():
    row = judge(claim(), [made_up(2.07)])
    assert (row["verdict"], row["verdict_half"], row["verdict_double"]) == (REPRODUCED, NOT_REPRODUCED, REPRODUCED)


def test_a_claim_without_data_is_not_decidable():
    bare = read_claim("test", {key: VALUE[key] for key in ("source", "statement", "rationale")}, "ch3.yaml", STUDIES)
    assert judge(bare.settings, [])["verdict"] == NOT_DECIDABLE
    assert (claims.band_text(bare.settings), claims.comparison_text(bare.settings)) == ("", "")
    nowhere = claim(select={"reduced_pressure": [0.5, 1.0]})
    assert judge(nowhere, [made_up()])["verdict"] == NOT_DECIDABLE


def test_an_unconverged_solution_leaves_a_claim_open_and_the_row_names_it():
    data = made_up()
    data["status"][0, 1, 2] = 1
    row = judge(claim(), [data])
    assert (row["verdict"], row["unknown"]) == (
        NOT_DECIDABLE,
        "κ at H = 0.2, member = 1, p* = 0.1",
    )


# --- orders -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "verdict", "worst"),
    [
        ([1.0, 2.0, 3.0], REPRODUCED, 10.0),
        ([1.0, 2.0, 1.95], REPRODUCED, -0.5),  # within its error a step has no sign
        ([1.0, 2.0, 2.0], REPRODUCED, 0.0),
        ([1.0, 2.0, 1.5], NOT_REPRODUCED, -5.0),
        ([1.0, 1.05, 1.0], NOT_DECIDABLE, -0.5),
        ([1.0, np.nan, 2.0], NOT_DECIDABLE, np.nan),
    ],
)
def test_an_order_holds_if_no_step_has_the_wrong_sign_by_two_errors(values, verdict, worst):
    error = 0.1 / np.sqrt(2)  # of each value, so 0.1 of each step
    data = paths(values, increment=error, work_ratio=[0.0, 0.5, 1.0])
    row = judge(path_claim(reduce="rising_steps", along="work_ratio", **BANDLESS), [data])
    assert (row["verdict"], row["value"]) == (verdict, pytest.approx(worst, nan_ok=True))
    falling = judge(
        path_claim(reduce="falling_steps", along="work_ratio", **BANDLESS),
        [data.assign(pull_off_load_loading=-data.pull_off_load_loading)],
    )
    assert falling["verdict"] == verdict


def test_steps_without_any_error_are_decided_by_their_sign():
    data = paths([1.0, 2.0, 2.0], increment=0.0, work_ratio=[0.0, 0.5, 1.0])
    assert judge(path_claim(reduce="rising_steps", along="work_ratio", **BANDLESS), [data])["verdict"] == REPRODUCED


def test_an_order_needs_a_change_from_end_to_end_and_fails_by_many_small_steps():
    one, error = np.ones(5), np.full(5, 1.0)
    whole = np.array([np.sqrt(2.0)])  # of two independent ends
    assert judge_steps((one, error), (np.array([5.0]), whole))[0].verdict == REPRODUCED
    result, worst = judge_steps((-one, error), (np.array([-5.0]), whole))
    assert (result.verdict, worst) == (NOT_REPRODUCED, -1.0)
    assert result.margin == pytest.approx(5 / np.sqrt(2))
    assert judge_steps((one / 5, error), (np.array([1.0]), whole))[0].verdict == NOT_DECIDABLE
    several = np.array([5.0, 1.0]), np.ones(2)  # of two variants, one of which does not change
    assert judge_steps((one, error), several)[0].verdict == NOT_DECIDABLE


# --- conditions ---------------------------------------------------------------------------------------------------


def test_the_largest_block_in_which_a_claim_holds_is_its_condition():
    row = judge(claim(), [made_up(2.25, tilt=0.25)])  # 2, 2.25 and 2.5 at the three loads: two in three are too large
    assert (row["verdict"], row["condition"]) == (NOT_REPRODUCED, "")
    assert np.isnan(row["condition_value"])
    assert (row["verdict_half"], row["verdict_double"]) == (NOT_REPRODUCED, CONDITION)  # each band has its own
    row = judge(claim(tolerance=0.2), [made_up(2.25, tilt=0.25)])
    assert (row["verdict"], row["condition"]) == (CONDITION, "p* from 0.001 to 0.01")
    assert (row["value"], row["condition_value"]) == pytest.approx((2.25, 2.125))
    assert row["condition_share"] == pytest.approx(2 / 3)


@pytest.mark.parametrize(("reduce", "condition"), [("largest_spread", True), ("largest_rise", False)])
def test_where_ends_are_compared_no_part_of_a_dimension_is_a_condition(reduce, condition):
    settings = claim(**BANDLESS, reduce=reduce, along="reduced_pressure", at_most=0.15, neutral=0.0)
    row = judge(settings, [made_up(2.25, tilt=0.25)])
    assert bool(row["condition"]) is condition
    assert row["verdict"] == (CONDITION if condition else NOT_REPRODUCED)


def test_a_dimension_of_another_clause_is_not_narrowed():
    row = judge(claim(tolerance=0.2, whole=["reduced_pressure"]), [made_up(2.25, tilt=0.25)])
    assert (row["verdict"], row["condition"]) == (NOT_REPRODUCED, "")
    with pytest.raises(InputError, match=r"claims\.test\.whole: got 'width'"):
        claim(whole=["width"])


def test_a_claim_that_holds_or_is_open_needs_no_condition():
    assert judge(claim(), [made_up()])["condition"] == ""
    assert judge(claim(), [made_up(2.25, tilt=0.25, grid=5.0)])["condition"] == ""


def test_what_a_claim_compares_is_never_narrowed_to_a_single_value():
    settings = claim(reduce="spread", along="hurst_exponent", **BANDLESS, at_most=0.1)
    blocks = [block for block, _ in narrower_blocks(Comparison(settings, [made_up()]))]
    assert blocks
    assert not any("hurst_exponent" in block for block in blocks)  # it has two values, both are needed
    shares = [share for _, share in narrower_blocks(Comparison(claim(), [made_up()]))]
    assert shares == sorted(shares, reverse=True)
    assert 0.5 <= min(shares) <= max(shares) < 1


# --- the grid of the thesis ---------------------------------------------------------------------------------------


def test_a_statement_about_the_grid_of_the_thesis_is_open_on_another():
    settings = claim(
        quantity="kappa_grid_error", against="kappa", reduce="ratio", expect=0.05, tolerance=0.02, grid="thesis"
    )
    assert judge(settings, [made_up(grid=0.1)])["verdict"] == REPRODUCED
    assert judge(settings, [made_up(grid=0.1, points=1024)])["verdict"] == NOT_DECIDABLE


# --- two rows -----------------------------------------------------------------------------------------------------


def judged(settings, *data):
    """The row of one claim."""
    names = [settings[key] for key in ("study", "relative_to") if settings[key]]
    return claims.judge_claims({"test": settings}, dict(zip(names, data, strict=True))).iloc[0]


def test_a_second_row_is_judged_beside_the_one_that_counts():
    settings = claim(quantity="kappa_corrected", beside="kappa")
    row = judged(settings, with_corrected(made_up(2.5, grid=0.3), 2.0, change=0.01, subgrid=2.0))
    assert (row.value, row.grid_error, row.verdict) == (pytest.approx(2.0), pytest.approx(0.01), REPRODUCED)
    assert (row.beside, row.beside_value, row.beside_verdict) == ("kappa", pytest.approx(2.5), NOT_REPRODUCED)
    assert row.beside_grid_error == 0  # on the thesis's own grid
    other = judged(settings, with_corrected(made_up(2.5, grid=0.3, points=1024), 2.0, change=0.01, subgrid=2.0))
    assert (other.beside_grid_error, other.beside_verdict) == (pytest.approx(0.3), NOT_DECIDABLE)


def test_a_stated_number_is_counted_on_the_thesis_s_grid_or_carried_there():
    settings = claim(beside="kappa_corrected", grid="thesis")
    row = judged(settings, with_corrected(made_up(2.0, grid=0.3), 2.5, change=0.01, subgrid=2.5))
    assert (row.measure, row.verdict, row.grid_error) == ("mean of kappa", REPRODUCED, 0)
    assert (row.beside_value, row.beside_grid_error) == (pytest.approx(2.5), pytest.approx(0.01))
    coarser = made_up(2.2, grid=-0.2, points=262144 // 4)  # counting adds 0.2 here, so 0.05 on the thesis's grid
    row = judged(settings, with_corrected(coarser, 2.0, change=0.0, subgrid=2.0))
    assert (row.measure, row.verdict) == ("mean of kappa_carried", REPRODUCED)
    assert [row.value, row.grid_error] == pytest.approx([2.05, 0.0], abs=1e-12)
    assert (row.beside, row.beside_value) == ("kappa_corrected", pytest.approx(2.0))


def test_the_error_of_a_carried_number_is_that_of_what_it_is_carried_from():
    settings = claim(beside="kappa_corrected", grid="thesis")
    row = judged(settings, with_corrected(made_up(2.2, grid=-0.2, points=262144 // 4), 2.0, change=0.04, subgrid=2.0))
    assert row.grid_error == pytest.approx(0.04 * (1 - 1 / 8))
    row = judged(settings, with_corrected(made_up(2.2, grid=-0.2, points=262144 // 4), 2.0, change=0.0, subgrid=2.1))
    assert row.grid_error == pytest.approx(0.1 * (1 - 1 / 4))


def test_a_carried_number_is_unknown_where_a_state_is_not_solved_and_needs_no_change_on_the_thesis_s_grid():
    settings = claim() | {"quantity": "kappa_carried"}
    data = with_corrected(made_up(2.2, points=262144 // 4), 2.0, change=0.0, subgrid=2.0)
    whole = Comparison(settings, [data])
    assert whole.number(whole.data) == pytest.approx(2.05)
    data.status[0, 0, 0] = Status.MAX_ITERATIONS.value[0]
    part = Comparison(settings, [data])
    assert np.isnan(part.number(part.data))
    alone = with_corrected(made_up(2.2), 2.0, change=0.0, subgrid=2.0).drop_vars("kappa_grid_change")
    assert estimate(Comparison(settings, [alone])).grid_error == 0.0


@pytest.mark.parametrize("name", sorted(name for name, reduction in REDUCTIONS.items() if reduction.locate))
@pytest.mark.parametrize("member", range(4))
def test_one_unsolved_state_makes_an_extreme_unknown_whichever_half_it_is_in(name, member):
    settings = claim() | {
        "reduce": name,
        "along": "reduced_pressure",
        "across": "hurst_exponent",
        "against": "relative_contact_area",
    }
    data = made_up(2.0, scatter=0.1, tilt=0.3)
    whole = Comparison(settings, [data])
    assert np.isfinite(whole.unbiased_number(whole.data))
    data.status[1, member, -1] = Status.MAX_ITERATIONS.value[0]
    part = Comparison(settings, [data])
    assert np.isnan(part.unbiased_number(part.data))


@pytest.mark.parametrize("name", FITTED)
def test_a_fit_to_areas_of_which_one_is_unknown_is_unknown_and_has_the_places_of_the_areas(name):
    data = made_up(1.8)
    data["relative_contact_area"] = xr.apply_ufunc(line_area, data.reduced_pressure, 0.6, 2.0) + 0 * data.kappa
    whole = mean_quantity(with_quantities(data, [name]), name)
    assert whole.reduced_pressure.values.tolist() == PRESSURES
    assert np.allclose(whole * data.reduced_pressure, line_area(np.array(PRESSURES), 0.6, 2.0), rtol=1e-6)
    data.status[0, 0, 0] = Status.MAX_ITERATIONS.value[0]
    part = mean_quantity(with_quantities(data, [name]), name)
    assert np.isnan(part[0]).all()
    assert np.isnan(part[1]).all() == FITTED[name][1]  # all exponents together


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"quantity": "kappa_r_pairs", "beside": "kappa_corrected"}, "quantity"),
        ({"study": "surface_resolution"}, "grid"),
        (BANDLESS | {"beside": "kappa_corrected", "reduce": "ratio", "against": "kappa_r", "at_most": 1.0}, "against"),
    ],
)
def test_a_number_that_cannot_be_on_the_thesis_s_grid_is_refused(changes, key):
    with pytest.raises(InputError, match=rf"claims\.test\.{key}"):
        claim(grid="thesis", **changes)


def test_the_grid_of_the_thesis_is_that_of_both_studies():
    settings = claim(**RATIO, beside="kappa_corrected", grid="thesis")
    lines, surfaces = (with_corrected(made_up(level), level, change=0.0, subgrid=level) for level in (1.8, 2.0))
    assert judged(settings, lines, surfaces).measure.startswith("mean of kappa in")
    assert judged(settings, lines, surfaces.assign(points=1024)).measure.startswith("mean of kappa_carried in")


def test_orders_have_second_rows_too():
    settings = claim(
        quantity="kappa_corrected", beside="kappa", reduce="rising_steps", along="reduced_pressure", **BANDLESS
    )
    row = judged(settings, with_corrected(made_up(2.0, tilt=0.3, scatter=0.01), 2.0, change=0.0, subgrid=2.0))
    assert (row.verdict, row.beside_verdict) == (NOT_DECIDABLE, REPRODUCED)


# --- two studies --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("key", "word", "value"), [("relative_to", "over", 0.9), ("minus", "minus", -0.2)])
def test_a_comparison_names_both_studies_and_asks_for_both(key, word, value):
    settings = claim(**{key: "rough_surface"}, expect=value, tolerance=0.05)
    assert claims.comparison_text(settings) == f"mean of kappa in rough_line {word} rough_surface"
    assert Claim("test", settings).studies == ["rough_line", "rough_surface"]
    data = {"rough_line": made_up(1.8), "rough_surface": made_up(2.0)}
    row = claims.judge_claims({"test": settings}, data).iloc[0]
    assert (row.value, row.study, row[key]) == (pytest.approx(value), "rough_line", "rough_surface")


# --- the claims of this project -----------------------------------------------------------------------------------


LACKING = {
    "ch2": [],
    "ch3": ["surface_area_linear"],
    "ch4": [
        *("compressible_slope", "compressible_curves_weak", "friction_size_4", "incompressible_slope_strong"),
        *("incompressible_slope_weak", "gap_at_pull_off", "crack_departure_strong", "compressible_slope_weak"),
    ],
    "ch5": [
        *("error_bars", "area_larger", "linearity_breaks", "error_bars_larger", "heights_ordered", "hurst_ordered"),
        *("gap_heights", "gap_hurst", "heights_linear", "hurst_linear", "no_slip", "no_slip_compressible"),
        *("uncoupled", "compressibility_adhesive", "friction", "gradient_after_contact_wall", "hurst_step"),
        "slipped_share",
    ],
    "ch6": ["share_in_tension"],
}
"""Claims that need members, coarser grids, works of separation or approaches that the quick tier leaves out."""


@pytest.mark.parametrize("chapter", LACKING)
def test_every_claim_of_the_config_is_judged(made, chapter):
    assert set(LACKING) == set(PLAN.claims)
    folder = made / "results/quick/claims"
    rows = pd.read_csv(folder / f"{chapter}.csv", keep_default_na=False, na_values=["", "nan"])
    assert rows.claim.tolist() == list(PLAN.claims[chapter])
    assert rows.verdict.isin(COLOURS).all()
    answered = rows.study.notna() | rows.measure.fillna("").str.startswith("exact number")
    assert answered.all()
    is_order = rows.measure.fillna("").str.startswith(tuple(ORDERS))  # its value is a step in its own errors
    known = np.isfinite(rows.value) & (np.isfinite(rows.ensemble_error) | is_order)
    assert rows.claim[~known].tolist() == LACKING[chapter]
    assert rows.verdict[~known].isin([NOT_DECIDABLE, FINDING]).all()


def test_the_table_shows_every_claim_in_the_colour_of_its_verdict():
    names = {verdict: Claim("x", claim()) for verdict in COLOURS}
    rows = claims.judge_claims({name: one.settings for name, one in names.items()}, {"rough_line": made_up()})
    rows["verdict"] = list(COLOURS)
    rows["condition"] = ["", "somewhere " * 9, *[""] * (len(COLOURS) - 2)]
    axes = claims_figure(rows, "Title", "footer " * 80).axes[0]
    shown = [text.get_text() for text in axes.texts]
    assert set(rows.statement) <= {text.replace("\n", " ") for text in shown}
    assert any("somewhere" in text and "\n" in text for text in shown)
    assert len({tuple(band.get_facecolor()[0]) for band in axes.collections}) == len(COLOURS) + 1


def test_verdicts_depend_on_claims_code_and_every_study_asked():
    settings = PLAN.claims_settings("ch3")
    asked = [part for _, entry in settings["claims"] for part in (entry, *(entry["cases"] or {}).values())]
    studies = {entry[key] for entry in asked for key in ("study", *SECOND_STUDY)}
    studies |= {name for entry in asked for name in entry["more_members"] or ()}
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
    ({"reduce": "guess"}, "reduce", "guess", "mean, trend, spread"),
    ({"reduce": None}, "reduce", None, "mean, trend, spread"),
    ({"quantity": "kapa"}, "quantity", "kapa", "kappa, kappa_corrected"),
    ({"quantity": None}, "quantity", None, "kappa, kappa_corrected"),
    ({"quantity": "half_width"}, "quantity", "half_width", "kappa"),
    ({"quantity": "kappa_r_limit"}, "quantity", "kappa_r_limit", "kappa"),  # on one grid
    ({"reduce": "spread", "along": "speed"}, "along", "speed", BOTH),
    ({"reduce": "spread"}, "along", None, BOTH),
    ({"along": "hurst_exponent"}, "along", "hurst_exponent", "mean does not use it"),
    ({"reduce": "ratio", "against": "area"}, "against", "area", "relative_contact_area"),
    ({"relative_to": "rough"}, "relative_to", "rough", "rough_line_many, rough_surface"),
    ({"relative_to": "rough_line"}, "relative_to", "rough_line", "rough_line_many, rough_surface"),
    ({"relative_to": "smooth_line"}, "relative_to", "smooth_line", "rough_surface"),
    ({"relative_to": "rough_surface", "quantity": "half_width"}, "quantity", "half_width", "kappa, kappa_corrected"),
    (
        {"relative_to": "rough_surface", "reduce": "ratio", "against": "kappa_r"},
        "reduce",
        "ratio",
        "mean, trend, spread",
    ),
    ({"select": {"contact_ratio": [0.1, 0.2]}}, "select.contact_ratio", [0.1, 0.2], BOTH),
    ({"select": {"hurst_exponent": [0.5, 0.1]}}, "select.hurst_exponent", [0.5, 0.1], "least and largest"),
    ({"tolerance": None}, None, ["expect"], "expect with tolerance"),
    ({"at_most": 3.0}, None, ["at_most", "expect", "tolerance"], "expect with tolerance"),
    ({"tolerance": 0.0}, "tolerance", 0.0, "a positive number"),
    ({"grid": "ours"}, "grid", "ours", "thesis"),
    ({"beside": "kapa"}, "beside", "kapa", "kappa_corrected"),
    ({"beside": "kappa"}, "beside", "kappa", "kappa_corrected"),
    ({"relative_to": "rough_surface", "minus": "rough_line_many"}, None, ["relative_to", "minus"], "one of them"),
    ({"reduce": "rising_steps", "along": "hurst_exponent"}, None, ["expect", "tolerance"], "only a sense"),
    (BANDLESS | {"reduce": "rising_steps", "along": "hurst_exponent", "neutral": 0.0}, None, ["neutral"], "a sense"),
    ({"absent": "no slip", "reduce": "spread", "along": "hurst_exponent"}, "absent", "no slip", "with mean, least"),
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


@pytest.mark.parametrize(
    ("changes", "key", "value"),
    [
        ({}, "", ["expect", "tolerance"]),
        (BANDLESS | {"neutral": 1.0}, "", ["neutral"]),
        (BANDLESS | {"reduce": "rising_steps", "along": "hurst_exponent"}, ".reduce", "rising_steps"),
        (BANDLESS | {"study": None}, ".study", None),
    ],
)
def test_a_finding_with_a_band_or_without_a_study_is_refused(changes, key, value):
    section = {name: entry for name, entry in (VALUE | changes).items() if entry is not None}
    with pytest.raises(InputError) as caught:
        read_claim("test", section, "ch3.yaml", STUDIES, "findings")
    assert (caught.value.key, caught.value.value) == (f"findings.test{key}", value)


def test_a_finding_has_a_number_and_no_verdict():
    section = {name: entry for name, entry in (VALUE | BANDLESS).items() if entry is not None}
    row = judge(read_claim("test", section, "ch3.yaml", STUDIES, "findings").settings, [made_up()])
    assert (row["verdict"], row["value"]) == (FINDING, pytest.approx(2.0))


def test_the_plan_refuses_a_bad_claim(tmp_path):
    for file in (ROOT / "config").glob("*.yaml"):
        text = file.read_text(encoding="utf-8")
        (tmp_path / file.name).write_text(text.replace("    reduce: fall\n", "    reduce: sink\n", 1), encoding="utf-8")
    with pytest.raises(InputError, match=r"ch3.yaml: claims.kappa_pressure.reduce: got 'sink'; allowed: one of mean"):
        Plan.read(tmp_path)
