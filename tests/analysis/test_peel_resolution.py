"""The share of peel exists only where the edges of the contact have moved far enough."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim.analysis.peel_resolution import leave_out_unresolved_peel


def test_the_share_of_peel_is_left_out_below_ten_errors_of_the_edges():
    peel = ("slide_approach", np.array([4.0, 0.4, -0.4]))
    values = {"peel_asymmetry": ("slide_approach", np.array([0.2, 0.9, -1.0]))}
    values |= {f"{edge}_peel": peel for edge in ("trailing", "leading")}
    data = xr.Dataset(values | {f"{edge}_peel_grid_error": 0.05 for edge in ("trailing", "leading")})
    np.testing.assert_array_equal(leave_out_unresolved_peel(data).peel_asymmetry, [0.2, np.nan, np.nan])
    finer = data.assign(leading_peel_grid_error=0.02)
    np.testing.assert_array_equal(
        leave_out_unresolved_peel(finer).peel_asymmetry, [0.2, 0.9, np.nan]
    )  # a contact that grows does not peel


def test_paths_without_peel_stay_as_they_are():
    data = xr.Dataset({"pull_off_load_loading": 1.0})
    assert leave_out_unresolved_peel(data).identical(data)
