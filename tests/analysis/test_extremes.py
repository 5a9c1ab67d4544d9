"""Where the extreme of a claim lies, and for how much of the selection the claim holds."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.analysis.claims import judge
from contactsim.analysis.comparison import Comparison
from contactsim.analysis.extremes import NO_EXTREME, describe_extreme
from contactsim.analysis.wording import extreme_text
from support.claims import BANDLESS, claim, made_up

LARGEST = claim(**BANDLESS, reduce="largest", at_most=2.05, neutral=2.0)


def described(settings, data):
    return describe_extreme(settings, Comparison(settings, [data]))


def tilted():
    """κ from 1.9 to 2.1 with p*, a tenth more at the larger H."""
    data = made_up(2.0, tilt=0.1)
    return data.assign(kappa=data.kappa + 0.1 * (data.hurst_exponent > 0.5))


def test_the_place_is_that_of_the_extreme_and_the_share_that_of_all_places_in_the_band():
    found = described(LARGEST, tilted())
    assert found["extreme_at"] == "H = 0.8, p* = 0.1"
    assert found["share_in_band"] == pytest.approx(3 / 6)  # 1.9, 2.0 and 2.0 of 1.9, 2.0, 2.1, 2.0, 2.1, 2.2
    least = described(claim(**BANDLESS, reduce="least", at_least=1.95, neutral=2.0), tilted())
    assert (least["extreme_at"], least["share_in_band"]) == ("H = 0.2, p* = 0.001", pytest.approx(5 / 6))


def test_a_row_has_them_and_they_follow_the_selection():
    row = judge(LARGEST, [tilted()])
    assert row["extreme_at"] == "H = 0.8, p* = 0.1"
    row = judge(LARGEST | {"select": {"hurst_exponent": [0.2, 0.2], "reduced_pressure": [0.001, 0.01]}}, [tilted()])
    assert (row["extreme_at"], row["share_in_band"]) == ("H = 0.2, p* = 0.01", 1.0)


@pytest.mark.parametrize(
    "settings",
    [
        claim(),
        claim(**BANDLESS, reduce="rising_steps", along="reduced_pressure"),
        LARGEST | {"select": {"hurst_exponent": [0.3, 0.4]}},
        LARGEST | {"select": {"hurst_exponent": [0.2, 0.2], "reduced_pressure": [0.1, 0.1]}},
    ],
)
def test_means_orders_empty_selections_and_single_places_have_none(settings):
    row = judge(settings, [tilted()])
    assert row["extreme_at"] == "" and np.isnan(row["share_in_band"])


def test_an_unknown_value_may_hide_the_extreme():
    data = tilted()
    data.kappa[0, 0, 0] = np.nan
    assert described(LARGEST, data) == pytest.approx(NO_EXTREME, nan_ok=True)


def test_a_finding_has_a_place_and_no_share():
    found = described(LARGEST | {"is_finding": True, "at_most": None, "neutral": None}, tilted())
    assert found["extreme_at"] == "H = 0.8, p* = 0.1" and np.isnan(found["share_in_band"])


@pytest.mark.parametrize(
    ("row", "text"),
    [
        ({"extreme_at": "H = 0.2", "share_in_band": 0.334}, "at H = 0.2; 33% of all in the band"),
        ({"extreme_at": "H = 0.2", "share_in_band": 1.0}, "at H = 0.2"),
        ({"extreme_at": "H = 0.2", "share_in_band": np.nan}, "at H = 0.2"),
        ({"extreme_at": "", "share_in_band": np.nan}, ""),
        ({"extreme_at": np.nan}, ""),
    ],
)
def test_the_place_is_told_with_the_share_unless_that_is_all(row, text):
    assert extreme_text(row) == text
