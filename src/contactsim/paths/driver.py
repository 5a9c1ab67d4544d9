"""Follow the load path of a scene: the driver of each kind of problem, looked up once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import xarray as xr

from contactsim.contact.scene import ProblemKind
from contactsim.errors import InputError
from contactsim.observables.contact import KEPT
from contactsim.paths.increments import Requested
from contactsim.paths.options import Setup
from contactsim.paths.pressures import Point, simulate_loads
from contactsim.paths.record import simulate_path
from contactsim.solvers.base import check_solver
from contactsim.solvers.registry import default_solver
from contactsim.threads import limit_threads


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


class PathDriver(Protocol):
    """Way to follow the load path of one kind of problem.

    Attributes
    ----------
    words
        Name of the kind in messages.
    options
        Run options that only it has.
    reuses_points
        True where a load does not depend on those before, so that it need not be solved again.
    """

    words: str
    options: tuple[str, ...]
    reuses_points: bool

    def follow(self, setup: Setup, solver: Any, reuse: Reuse) -> xr.Dataset:
        """Return a dataset with dimension `step`; the solver is of the kind of problem."""
        ...


class LoadDriver:
    """Loads on their own at a hard wall."""

    words = "a hard wall"
    options: tuple[str, ...] = ("keep",)
    reuses_points = True

    def follow(self, setup: Setup, solver: Any, reuse: Reuse) -> xr.Dataset:
        """Return one solution for each load."""
        options = setup.options
        return simulate_loads(
            setup.scene,
            solver,
            points=setup.points,
            tolerance=options.tolerance,
            threads=options.threads,
            keep=KEPT[:-1] if options.keep is None else options.keep,
            solved_points=reuse.points,
            coarse=reuse.coarse,
        )


class StateDriver:
    """States of cohesive laws, each from the one before."""

    words = "smooth laws"
    options: tuple[str, ...] = ("increments", "snapshots", "keep_fields", "until")
    reuses_points = False

    def follow(self, setup: Setup, solver: Any, reuse: Reuse) -> xr.Dataset:
        """Return one state for each step; nothing can be reused, as each state depends on all before."""
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


DRIVERS: dict[ProblemKind, PathDriver] = {ProblemKind.HARD_WALL: LoadDriver(), ProblemKind.COHESIVE: StateDriver()}


def follow_path(setup: Setup, reuse: Reuse | None = None) -> xr.Dataset:
    """Follow the load path of a scene, as its options are.

    Returns
    -------
    xarray.Dataset
        One dataset with dimension `step`: numbers, and what is kept; `seconds` is the one variable that is not
        reproducible.

    Raises
    ------
    InputError
        For an option that such a scene has no use for, or a solver that does not accept it.
    """
    scene, options = setup.scene, setup.options
    driver = DRIVERS[scene.kind]
    unused = {name for other in DRIVERS.values() for name in other.options} - set(driver.options)
    for name, value in vars(options).items():
        if name in unused and value is not None:
            used = ", ".join(name for name in vars(options) if name not in unused)
            raise InputError(name, value, f"none with {driver.words}, only {used}")
    solver = default_solver(scene) if options.solver is None else options.solver
    check_solver(solver, scene)
    with limit_threads(options.threads):
        return driver.follow(setup, solver, reuse or Reuse())
