"""Two rough bodies: their heights add, at an offset, and what does not face each other is left out."""

from __future__ import annotations

import numpy as np
import pytest

import contactsim as cs
from support.cases import refused, rough

LOAD = {"contact_modulus": 1.0, "mean_pressure": 0.02}


def test_two_profiles_touch_where_the_sum_of_their_heights_does():
    first, second = rough(128), rough(128)[::-1]
    pair = cs.press(first, second, spacing=1.0, **LOAD)
    assert np.array_equal(pair.pressure, cs.press(first + second, spacing=1.0, **LOAD).pressure)
    assert np.array_equal(pair.pressure, cs.press(second, first, spacing=1.0, **LOAD).pressure)


@pytest.mark.parametrize("move", [0, 5, -3])
def test_an_offset_moves_the_other_body_and_periods_close(move):
    first, second = rough(128), rough(128)[::-1]
    moved = cs.press(first, second, offset=move, spacing=1.0, **LOAD)
    assert np.array_equal(moved.pressure, cs.press(first, np.roll(second, move), spacing=1.0, **LOAD).pressure)


@pytest.mark.parametrize("move", [(0, 0), (2, -3), (-4, 1)])
def test_of_two_scans_the_part_that_faces_each_other_is_pressed(move):
    fields = np.random.default_rng(0).normal(size=(2, 20, 24))
    first, second = cs.Topography(fields[0], 2.0), cs.Topography(fields[1, :18], 2.0)
    result = cs.press(first, second, offset=move, **LOAD)
    facing = {
        (y, x): fields[1, y - move[0], x - move[1]]
        for y in range(20)
        for x in range(24)
        if 0 <= y - move[0] < 18 and 0 <= x - move[1] < 24
    }
    rows, columns = sorted({y for y, _ in facing}), sorted({x for _, x in facing})
    heights = np.array([[fields[0, y, x] + facing[y, x] for x in columns] for y in rows])
    assert np.array_equal(result.pressure, cs.press(cs.Topography(heights, 2.0), **LOAD).pressure)


def test_an_array_takes_the_spacing_of_the_topography_beside_it():
    first, second = np.random.default_rng(0).normal(size=(2, 12, 10))
    both = cs.press(cs.Topography(first, 2.0), cs.Topography(second, 2.0), offset=np.array([1, 2]), **LOAD)
    for pair in ((cs.Topography(first, 2.0), second), (first, cs.Topography(second, 2.0))):
        one = cs.press(*pair, offset=(1, 2), periodic=False, **LOAD)
        assert np.array_equal(one.pressure, both.pressure)
    assert both.pressure.shape == (11, 8)


def test_bodies_that_do_not_fit_are_refused():
    line, area = np.zeros(16), np.zeros((16, 16))
    for key, allowed, other, options in (
        ("other", "that of heights, (16,)", area, {}),
        ("other", "that of heights, (16,)", line[:8], {}),
        ("other", "none missing", np.ma.masked_equal(line, 0), {}),
        ("offset", "whole number", line, {"offset": 0.5}),
        ("offset", "whole points along x", line, {"offset": (1, 1)}),
        ("offset", "without the heights of another body", None, {"offset": 1}),
        ("offset", "two points or more", line, {"offset": 15, "periodic": False}),
    ):
        with refused(key, allowed):
            cs.press(line, other, spacing=1.0, **LOAD, **options)
    for other in ([], np.full(16, np.nan), ["a", "b"]):
        with refused("other", ""):
            cs.press(line, other, spacing=1.0, **LOAD)
    with refused("periodic", "True or False"):
        cs.press(line, line[:8], periodic="no", spacing=1.0, **LOAD)
    with refused("offset", "a pair of whole points"):
        cs.press(area, area, offset=1, spacing=1.0, **LOAD)
    with refused("other", "that of heights, (1.0,)"):
        cs.press(cs.Topography(line, 1.0), cs.Topography(line, 2.0), **LOAD)
