"""Follow the states of smooth laws, each from the one before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from contactsim.contact.pose_cohesive import check_tolerance
from contactsim.errors import InputError
from contactsim.paths.options import Setup
from contactsim.paths.record import simulate_path
from contactsim.paths.requested import Requested
from contactsim.paths.reuse import Point, Reuse


class CohesiveDriver:
    """States of smooth laws: each depends on all before, so none can be reused."""

    def check(self, setup: Setup) -> None:
        """Raise InputError for a tolerance, increments or snapshots that the path cannot have."""
        scene, options = setup.scene, setup.options
        check_tolerance(options.tolerance)
        _check_increments(setup)
        solver: Any = options.solver  # one of cohesive problems, as the scene has been checked
        (options.increments or Requested()).check(setup.points, scene.path.steps, solver)
        for value in options.snapshots or ():
            scene.path.nearest(value)

    def follow(self, setup: Setup, solver: Any, reuse: Reuse) -> xr.Dataset:
        """Return one state for each step."""
        _check_increments(setup)
        options = setup.options
        return simulate_path(
            setup.scene,
            solver,
            points=setup.points,
            tolerance=options.tolerance,
            threads=options.threads,
            increments=options.increments or Requested(),
            snapshots=options.snapshots,
            keep_fields=options.keep_fields is not False,
            until_complete=options.until is not None,
        )

    def read_points(self, data: str | Path, costs: str | Path) -> dict[str, Point]:
        """Return no state of an earlier dataset."""
        return {}


def _check_increments(setup: Setup) -> None:
    """Raise InputError for nested grids of heights that do not repeat."""
    increments = setup.options.increments or Requested()
    if increments.needs_period and not setup.scene.repeats:
        kind = type(increments).__name__.lower()
        raise InputError("increments", kind, "requested or adaptive, as the heights do not repeat")
