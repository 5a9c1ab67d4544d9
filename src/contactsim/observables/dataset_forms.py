"""The three forms of a dataset: loads on their own, approaches to a hard wall, and cohesive paths.

The attribute `problem` of a dataset and the dimension of its load say which form it has. A form knows which numbers
are derived from its states, which are averaged over members, and which summarise a path.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import xarray as xr

from contactsim.contact.problem_kind import ProblemKind
from contactsim.observables.contact_readings import READINGS
from contactsim.observables.deformation import AT_ONE_STATE, DEFORMATION
from contactsim.observables.derived import summarise_approaches, summarise_paths
from contactsim.observables.friction import ONSET
from contactsim.observables.hysteresis import CYCLE
from contactsim.observables.linearity import AREA_LOAD
from contactsim.observables.path_summary import FINAL, SUMMARY, SURFACE_FINAL, SURFACE_SUMMARY
from contactsim.observables.proportionality import derive_contact_factors
from contactsim.observables.threshold import THRESHOLD
from contactsim.variables import LOADS

STEP = "step"
"""Dimension of the load of a path."""
KEPT_NUMBERS = (
    "contact_stiffness",
    "reduced_stiffness",
    "yielding_share",
    "patches",
    "largest_patch_share",
    "spanning",
    "pressure_density",
    "gap_density",
    "patches_by_area",
)
"""Numbers of a state at a hard wall that only some runs have, which were asked for them."""
AVERAGED = (
    "relative_contact_area",
    "relative_contact_area_corrected",
    "relative_contact_area_subgrid",
    "kappa",
    "kappa_corrected",
    "kappa_subgrid",
    "kappa_r",
    "kappa_r_corrected",
    "kappa_r_subgrid",
    "kappa_r_pairs",
    "rms_gradient_contact",
    "rms_gradient_contact_corrected",
    "rms_gradient_contact_subgrid",
    "rms_gradient_contact_pairs",
    "reduced_pressure_contact",
    "reduced_pressure_contact_corrected",
    "mean_gap",
    "reduced_gap",
    "max_pressure",
    *KEPT_NUMBERS,
)
"""Numbers of a state at a hard wall that are averaged over members."""
AVERAGED_STATES = (
    "mean_pressure",
    "normalised_pressure",
    "relative_repulsive_area",
    "relative_interacting_area",
    "gradient_ratio_repulsive",
    "gradient_ratio_interacting",
    "mean_gap",
)
"""Numbers of a state of a cohesive path that are averaged over members."""
PATH_SUMMARIES = (*SUMMARY, *SURFACE_SUMMARY, *CYCLE, *DEFORMATION, *AREA_LOAD, *READINGS, *ONSET, *THRESHOLD)
"""Numbers that summarise a path."""
EXACT_SUMMARIES = (*FINAL, *SURFACE_FINAL, *AT_ONE_STATE, "max_jump_loading", "max_jump_unloading")
"""Those of a single state, or of a jump that is known by both its sides: the increments leave no error in them."""


class DatasetForm(Protocol):
    """A form of datasets."""

    @property
    def averaged(self) -> tuple[str, ...]:
        """Numbers of a state that are averaged over members."""
        ...

    @property
    def is_path(self) -> bool:
        """True if summaries of the whole path exist."""
        ...

    @property
    def compares_one_member(self) -> bool:
        """True if changes of the averaged numbers are measured for one member too."""
        ...

    def derive(self, data: xr.Dataset) -> xr.Dataset:
        """Return the dataset with the numbers derived from its states."""
        ...


@dataclass(frozen=True)
class SeparateLoads:
    """Loads at a hard wall, each solved on its own."""

    averaged: tuple[str, ...] = AVERAGED
    is_path: bool = False
    compares_one_member: bool = True

    def derive(self, data: xr.Dataset) -> xr.Dataset:
        """Return the dataset with its contact factors."""
        return derive_contact_factors(data)


@dataclass(frozen=True)
class Paths:
    """Paths whose states start from one another, or that are summarised as a whole."""

    averaged: tuple[str, ...]
    compares_one_member: bool
    summarise: Callable[[xr.Dataset], xr.Dataset]
    is_path: bool = True

    def derive(self, data: xr.Dataset) -> xr.Dataset:
        """Return the dataset with normalised states and the summaries of its paths."""
        return self.summarise(data)


FORMS: dict[tuple[str, str], DatasetForm] = {
    **dict.fromkeys(((ProblemKind.HARD_WALL.value, load) for load in LOADS), SeparateLoads()),
    (ProblemKind.HARD_WALL.value, STEP): Paths((*AVERAGED, "normalised_pressure"), True, summarise_approaches),
    (ProblemKind.COHESIVE.value, STEP): Paths(AVERAGED_STATES, False, summarise_paths),
}
"""Forms by the attribute `problem` of a dataset and the dimension of its load."""


def load_dimension(data: xr.Dataset) -> str:
    """Return the name of the dimension along which the load varies."""
    return next(name for name in (*LOADS, STEP) if name in data.dims)


def form_of(data: xr.Dataset) -> DatasetForm:
    """Return the form of a dataset."""
    return FORMS[data.attrs["problem"], load_dimension(data)]
