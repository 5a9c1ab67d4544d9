"""Every reduction gives what a hand would, and leaves unknown what is unknown."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from contactsim.analysis import measures
from contactsim.analysis.measures import SPLIT
from contactsim.analysis.reductions import ORDERS, REDUCTIONS

LOADS = [0.001, 0.01, 0.1]
WORKS, RATIOS = [1.0, 2.0], [0.0, 0.5, 1.0]


def array(values, **places):
    return xr.DataArray(values, places, dims=tuple(places))


BOTH = array([[2.0, 4.0, 3.0], [1.0, 1.0, 1.0]], hurst_exponent=[0.2, 0.8], reduced_pressure=LOADS)
GRID = array([[10.0, 12.0, 11.0], [20.0, 21.0, 30.0]], work_of_separation=WORKS, work_ratio=RATIOS)
CUBE = array(
    [[[10.0, 11.0], [20.0, 30.0]], [[10.0, 12.0], [20.0, 26.0]]],
    poisson_ratio=[0.1, 0.3], work_of_separation=WORKS, work_ratio=[0.0, 1.0],
)  # fmt: skip
LOAD = array([1.0, 10.0, 100.0], reduced_pressure=LOADS)
ALONG_LOAD, ALONG_RATIO = {"along": "reduced_pressure"}, {"along": "work_ratio"}
CASES = [
    ("mean", BOTH, {}, (3.25 + 1) / 2),
    ("mean", GRID, {}, 104 / 6),
    ("spread", BOTH, ALONG_LOAD, (2 / 3 + 0) / 2),
    ("spread", BOTH, {"along": "hurst_exponent"}, (1 / 1.5 + 2 * 3 / 2.5 + 2 / 2) / 4),
    ("spread", -BOTH, ALONG_LOAD, (2 / 3 + 0) / 2),
    ("largest_spread", GRID, ALONG_RATIO, 10 / (71 / 3)),
    ("largest_spread", array([[1, 2], [3, 4], [5, 6.0]], poisson_ratio=[0, 1, 2], work_ratio=[0, 1]),
     {"along": "poisson_ratio"}, 4 / 3),
    ("largest_difference", GRID, ALONG_RATIO, 30.0),
    ("largest_difference", array([[-1.0, -3.0], [2.0, -4.0]], work_ratio=[0, 1], poisson_ratio=[0, 1]),
     {"along": "work_ratio"}, 4.0),
    ("spread_ratio", BOTH, {"against": 2 * BOTH} | ALONG_LOAD, 1.0),
    ("trend", BOTH, ALONG_LOAD, (1 / 3 + 0) / 2),
    ("trend", array([3.0, 2.0, 1.0], hurst_exponent=[0.2, 0.5, 0.8]), {"along": "hurst_exponent"}, -1.0),
    ("slope", LOAD**0.5, {"against": LOAD} | ALONG_LOAD, 0.5),
    ("slope", GRID, {"against": GRID.work_of_separation, "along": "work_of_separation"},
     np.log2([2, 21 / 12, 30 / 11]).mean()),
    ("largest_slope", GRID, {"against": GRID.work_of_separation, "along": "work_of_separation"}, np.log2(30 / 11)),
    ("slope_furthest_from_one", GRID, {"against": GRID.work_of_separation, "along": "work_of_separation"},
     np.log2(30 / 11)),
    ("slope_furthest_from_one", 1 / GRID, {"against": GRID.work_of_separation, "along": "work_of_separation"},
     -np.log2(30 / 11)),
    ("origin_slope", BOTH, {"against": LOAD} | ALONG_LOAD, ((2 + 40 + 300) / 10101 + 111 / 10101) / 2),
    ("fall", BOTH, ALONG_LOAD, (-0.5 + 0) / 2),
    ("rise", GRID, ALONG_RATIO, (0.1 + 0.5) / 2),
    ("least_rise", GRID, ALONG_RATIO, 0.1),
    ("largest_rise", GRID, ALONG_RATIO, 0.5),
    ("rise_gain", GRID, {"across": "work_of_separation"} | ALONG_RATIO, 0.4),
    ("least_rise_gain", CUBE, {"across": "work_of_separation"} | ALONG_RATIO, 0.1),
    ("largest_rise_gain", CUBE, {"across": "work_of_separation"} | ALONG_RATIO, 0.4),
    ("shortfall", GRID, ALONG_RATIO, (1 / 11 + 1 / 3) / 2),
    ("excess", GRID, ALONG_RATIO, -(1 / 11 + 1 / 3) / 2),
    ("departure", BOTH, {"against": array([2.0, 2.0, 2.0], reduced_pressure=LOADS)}, 1.0),
    ("departure", -BOTH, {"against": -4 + 0 * BOTH}, 0.75),
    ("ratio", BOTH, {"against": LOAD}, 2.0),
    ("correlation", GRID, {"against": 5 - 2 * GRID}, -1.0),
    ("correlation", array([1.0, 2.0, 3.0], reduced_pressure=LOADS), {"against": array([1.0, 3.0, 2.0],
     reduced_pressure=LOADS)}, 0.5),
    ("least", GRID, {}, 10.0),
    ("largest", GRID, {}, 30.0),
    ("furthest_from_one", 0.05 * GRID, {}, 0.5),
    ("furthest_from_one", 0.1 * GRID, {}, 3.0),
    ("largest_size", array([[-3.0, 1.0], [2.0, 2.5]], poisson_ratio=[0, 1], work_ratio=[0, 1]), {}, 3.0),
    ("ratio_size", -BOTH, {"against": LOAD}, 2.0),
]  # fmt: skip


@pytest.mark.parametrize("loads", [[0.001, 0.1], [0.001, 0.01, 0.1], [0.001, 0.0011, 0.0012, 0.07, 0.1]])
def test_a_mean_over_loads_depends_on_their_range_and_not_on_their_number(loads):
    values = array(5 + np.log10(loads), reduced_pressure=loads)
    assert REDUCTIONS["mean"](values) == pytest.approx(3.0)


def test_a_mean_over_one_load_is_the_value_there():
    assert REDUCTIONS["mean"](array([3.0], reduced_pressure=[0.01])) == 3.0


@pytest.mark.parametrize(("name", "values", "inputs", "expected"), CASES, ids=[case[0] for case in CASES])
def test_each_reduction_equals_a_calculation_by_hand(name, values, inputs, expected):
    assert REDUCTIONS[name](values, **inputs) == pytest.approx(expected)


def test_every_reduction_is_tried_by_hand():
    assert {case[0] for case in CASES} == set(REDUCTIONS)


@pytest.mark.parametrize(("name", "values", "inputs", "expected"), CASES, ids=[case[0] for case in CASES])
def test_one_unknown_value_makes_every_reduction_unknown(name, values, inputs, expected):
    for place in (dict.fromkeys(values.dims, 0), dict.fromkeys(values.dims, -1)):
        gap = values.copy()
        gap[place] = np.nan
        assert np.isnan(REDUCTIONS[name](gap, **inputs))


@pytest.mark.parametrize(("name", "sign"), [("rising_steps", 1), ("falling_steps", -1)])
def test_steps_of_an_order_are_positive_in_its_sense_and_unknown_beside_an_unknown_value(name, sign):
    steps = ORDERS[name](array([1.0, 3.0, np.nan, 2.0], hurst_exponent=[0.2, 0.4, 0.6, 0.8]), "hurst_exponent")
    assert np.array_equal(steps, [2.0 * sign, np.nan, np.nan], equal_nan=True)


def test_steps_to_one_count_the_distance_from_either_side():
    values = array([0.8, 1.1, 1.1, 0.7], work_ratio=[0.0, 0.1, 1.0, 10.0])
    assert np.allclose(ORDERS["steps_to_one"](values, "work_ratio"), [0.1, 0.0, -0.2])
    assert np.allclose(ORDERS["steps_from_one"](values, "work_ratio"), [-0.1, 0.0, 0.2])


def test_places_of_extremes_can_come_from_other_data():
    spread = REDUCTIONS["spread"]
    places = spread.places(array([1.0, 2.0, 3.0], reduced_pressure=LOADS), along="reduced_pressure")
    measured = spread.measure_at(places, array([3.0, 2.0, 1.0], reduced_pressure=LOADS), along="reduced_pressure")
    assert measured == pytest.approx(-1.0)  # a range whose order does not repeat is negative


def test_ranges_do_not_depend_on_the_order_of_dimensions_of_values_and_places():
    low, high = measures.ends_of_range(CUBE, "work_ratio")
    turned = CUBE.transpose("work_ratio", "work_of_separation", "poisson_ratio")
    found = measures.ranges(turned, (low, high), "work_ratio")
    expected = [[1 / 10.5, 10 / 25], [2 / 11, 6 / 23]]
    assert np.allclose(found.transpose("poisson_ratio", "work_of_separation"), expected)


@pytest.mark.parametrize("name", [name for name, reduction in REDUCTIONS.items() if reduction.locate is not None])
def test_the_numbers_of_many_halves_are_those_of_each(name):
    random = np.random.default_rng(3)
    dims, shape = (SPLIT, "hurst_exponent", "reduced_pressure"), (5, 3, 4)
    places = {"hurst_exponent": [0.2, 0.5, 0.8], "reduced_pressure": [0.001, 0.01, 0.05, 0.1]}
    searched, measured, against = (xr.DataArray(1 + random.random(shape), places, dims) for _ in range(3))
    reduction, given = REDUCTIONS[name], {"against": against, "along": "reduced_pressure", "across": "hurst_exponent"}
    inputs = {key: given[key] for key in reduction.inputs}
    numbers = reduction.measure_at(reduction.places(searched, **inputs), measured, **inputs)
    for split in range(5):
        one = {key: value.isel(split=split) if key == "against" else value for key, value in inputs.items()}
        found = reduction.places(searched.isel(split=split), **one)
        assert float(numbers[split]) == reduction.measure_at(found, measured.isel(split=split), **one)


def test_curves_depart_from_another_by_a_share_of_its_largest_value():
    curve = array([1.0, -4.0, 2.0], curve_approach=[1.0, 2.0, 3.0])
    curves = curve + array([0.0, 1.0], work_of_separation=WORKS)
    departure = measures.departure_of_curves(curves, curve)
    assert np.allclose(departure.sel(work_of_separation=1.0), 0.0)
    assert np.allclose(departure.sel(work_of_separation=2.0), 0.5)
    halves = xr.concat([curve, 2 * curve], SPLIT)
    assert np.allclose(measures.departure_of_curves(halves + 1, halves).isel({SPLIT: 1}), 0.25)
    assert np.isnan(measures.departure_of_curves(curves, curve.where(curve > 1.5))).all()


def test_the_largest_difference_of_two_curves_counts_the_one_that_they_depart_from():
    above = array([[0.2, 0.3], [0.1, 0.4]], work_of_separation=WORKS, curve_approach=[1.0, 2.0])
    largest = REDUCTIONS["largest_difference"]
    assert largest(above, along="work_of_separation") == pytest.approx(0.4)
    assert largest(-above, along="work_of_separation") == pytest.approx(0.4)
    assert largest(above - 0.25, along="work_of_separation") == pytest.approx(0.15)
