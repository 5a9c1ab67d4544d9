"""Follow the loads of a scene at a hard wall, each on its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import xarray as xr

from contactsim.observables.contact import DEFAULT_KEPT
from contactsim.paths.options import Setup
from contactsim.paths.pressures import read_points, simulate_loads
from contactsim.paths.reuse import Point, Reuse


class HardWallDriver:
    """Loads on their own at a hard wall: one need not be solved again if an earlier dataset holds it."""

    def check(self, setup: Setup) -> None:
        """Do nothing: any options go together."""

    def follow(self, setup: Setup, solver: Any, reuse: Reuse) -> xr.Dataset:
        """Return one solution for each load."""
        options = setup.options
        return simulate_loads(
            setup.scene,
            solver,
            points=setup.points,
            tolerance=options.tolerance,
            threads=options.threads,
            keep=DEFAULT_KEPT if options.keep is None else options.keep,
            solved_points=reuse.points,
            coarse=reuse.coarse,
        )

    def read_points(self, data: str | Path, costs: str | Path) -> dict[str, Point]:
        """Return the loads that an earlier dataset holds, by their digest."""
        return read_points(data, costs)
