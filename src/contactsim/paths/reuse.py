"""Earlier results that a simulation at a hard wall can use."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import xarray as xr

from contactsim.grid import Array


@dataclass(frozen=True)
class Point:
    """One solved load.

    Parameters
    ----------
    numbers : dict
        Numbers by name.
    arrays : dict
        Arrays that are kept, by name.
    seconds : float
        CPU seconds of the solution.
    """

    numbers: dict[str, float]
    arrays: dict[str, Array]
    seconds: float


@dataclass(frozen=True)
class Reuse:
    """Earlier results that a simulation at a hard wall can use.

    Parameters
    ----------
    points : mapping from int to Point
        Load steps that need not be solved again, by their number.
    coarse : xarray.Dataset, optional
        The same scene on a coarser grid with its fields, from which a cascade of grids begins.
    """

    points: Mapping[int, Point] | None = None
    coarse: xr.Dataset | None = None
