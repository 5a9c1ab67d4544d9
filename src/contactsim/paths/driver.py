"""Follow the load path of a scene by the driver of its kind of problem."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

import xarray as xr

from contactsim.contact.problem_kind import ProblemKind
from contactsim.errors import InputError
from contactsim.grid import check_memory
from contactsim.paths.options import Setup
from contactsim.paths.reuse import Point, Reuse
from contactsim.solvers.base import check_solver
from contactsim.solvers.registry import default_solver
from contactsim.surfaces.topography import MEASURED, Topography, is_gentle
from contactsim.threads import limit_threads


class PathDriver(Protocol):
    """Way to follow the load path of one kind of problem."""

    def check(self, setup: Setup) -> None:
        """Raise InputError for options that cannot work."""
        ...

    def follow(self, setup: Setup, solver: Any, reuse: Reuse) -> xr.Dataset:
        """Return a dataset with dimension `step`; the solver is of the kind of problem."""
        ...

    def read_points(self, data: str | Path, costs: str | Path) -> dict[str, Point]:
        """Return the steps of an earlier dataset that need not be solved again, by their digest."""
        ...


DRIVERS = {
    ProblemKind.HARD_WALL: "contactsim.paths.hard_wall_driver:HardWallDriver",
    ProblemKind.COHESIVE: "contactsim.paths.cohesive_driver:CohesiveDriver",
}
"""Module and class of each driver: a run loads only the one that it uses, and its results depend on no other."""
PROBLEMS = {ProblemKind.HARD_WALL: "a hard wall", ProblemKind.COHESIVE: "smooth laws"}
"""Kinds of problem in messages."""
OPTIONS = {
    ProblemKind.HARD_WALL: ("keep",),
    ProblemKind.COHESIVE: ("increments", "snapshots", "keep_fields", "until"),
}
"""Run options that only one kind of problem has."""


def driver_module(kind: ProblemKind) -> str:
    """Return the name of the module that follows paths of a kind of problem."""
    return DRIVERS[kind].partition(":")[0]


def path_driver(kind: ProblemKind) -> PathDriver:
    """Return the driver of a kind of problem; importing its module."""
    driver: PathDriver = getattr(import_module(driver_module(kind)), DRIVERS[kind].partition(":")[2])()
    return driver


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
        For an option that such a scene has no use for, a solver that does not accept it, a grid that needs more memory
        than is free, or measured heights that are too steep.
    """
    scene, options = setup.scene, setup.options
    unused = {name for names in OPTIONS.values() for name in names} - set(OPTIONS[scene.kind])
    for name, value in vars(options).items():
        if name in unused and value is not None:
            used = ", ".join(name for name in vars(options) if name not in unused)
            raise InputError(name, value, f"none with {PROBLEMS[scene.kind]}, only {used}")
    solver = default_solver(scene) if options.solver is None else options.solver
    check_solver(solver, scene)
    check_memory(setup.points, scene.upper.surface.shape(setup.points), solver.fields * len(scene.components))
    for name, body in {"upper": scene.upper, "lower": scene.lower}.items():
        if isinstance(body.surface, Topography) and not is_gentle(body.surface):
            raise InputError(name, body.surface, MEASURED)
    with limit_threads(options.threads):
        return path_driver(scene.kind).follow(setup, solver, reuse or Reuse())
