"""Distance of the distribution of a profile's heights from a Gaussian."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.analysis.costs import heights_of_run
from contactsim.grid import Array


def gaussian_distance(heights: Array) -> float:
    """Return the Kolmogorov-Smirnov distance of heights from a Gaussian of their own mean and rms height."""
    from scipy.special import ndtr

    ordered = np.sort(heights, axis=None)
    gaussian = ndtr((ordered - ordered.mean()) / ordered.std())
    steps = np.arange(ordered.size + 1) / ordered.size
    return float(max((steps[1:] - gaussian).max(), (gaussian - steps[:-1]).max()))


def height_distances(runs: Sequence[dict]) -> xr.Dataset:
    """Return `height_distance` of the runs of a study, each of which keeps its profile, by varied keys and member.

    runs: path, coordinates and member of each run, as `contactsim.analysis.aggregate.aggregate` has them.
    """
    parts: list[xr.Dataset] = []
    for run in runs:
        heights, _ = heights_of_run(dataset.load_dataset(run["path"]))
        places = run["coordinates"] | {"member": run["member"]}
        distance = xr.Dataset({"height_distance": gaussian_distance(heights)})
        parts.append(distance.expand_dims({name: [value] for name, value in places.items()}))
    combined = xr.combine_by_coords(parts, join="outer", compat="no_conflicts")
    return cast(xr.Dataset, combined)  # never an array, as datasets are given
