"""The registry of solvers: from a name in the configuration to a class.

Classes are named, not imported: a run loads only the method that it uses, and its results depend on no other.
"""

from __future__ import annotations

from importlib import import_module, metadata
from importlib.util import find_spec
from typing import Annotated, Any

from contactsim.arguments import Only
from contactsim.contact.problem_kind import ProblemKind
from contactsim.contact.scene import Scene
from contactsim.errors import InputError

SOLVERS = {
    "active_set": "contactsim.solvers.hard_wall.active_set:NestedActiveSet",
    "polonsky_keer": "contactsim.solvers.hard_wall.polonsky_keer:PolonskyKeer",
    "verlet": "contactsim.solvers.hard_wall.verlet:HardWallVerlet",
    "tamaas": "contactsim.solvers.hard_wall.tamaas:Tamaas",
    "conjugate_gradients": "contactsim.solvers.hard_wall.conjugate_gradients:NestedConjugateGradients",
    "newton": "contactsim.solvers.cohesive.newton_krylov:NewtonKrylov",
    "damped_verlet": "contactsim.solvers.cohesive.damped_verlet:DampedVerlet",
    "mass_weighted_verlet": "contactsim.solvers.cohesive.damped_verlet:MassWeightedVerlet",
    "energy_minimisation": "contactsim.solvers.cohesive.energy_minimisation:EnergyMinimisation",
}
"""Module and class of each solver."""
DEFAULT_SOLVERS = {
    (ProblemKind.HARD_WALL, 1): "active_set",
    (ProblemKind.HARD_WALL, 2): "conjugate_gradients",
    (ProblemKind.COHESIVE, 1): "newton",
    (ProblemKind.COHESIVE, 2): "newton",
}
"""Solver that is used unless another one is asked for, by kind of problem and number of dimensions."""
SolverName = Annotated[str, Only("the name of a solver", bool)]
REQUIRED_PACKAGES = {"tamaas": "tamaas"}
"""Package that a solver needs beside those that contactsim depends on."""


def solver_module(kind: str) -> str:
    """Return the name of the module that defines a solver.

    Raises
    ------
    InputError
        If there is no solver of that name.
    """
    if kind not in SOLVERS:
        raise InputError("solver", kind, f"one of {', '.join(sorted(SOLVERS))}")
    return SOLVERS[kind].partition(":")[0]


def solver_class(kind: str) -> Any:
    """Return the class of a solver; importing its module."""
    return getattr(import_module(solver_module(kind)), SOLVERS[kind].partition(":")[2])


def default_solver_name(scene: Scene) -> str:
    """Return the name of the solver that is used for a scene unless another one is asked for."""
    return DEFAULT_SOLVERS[scene.kind, len(scene.lengths)]


def default_solver(scene: Scene) -> Any:
    """Return the solver that is used for a scene unless another one is asked for."""
    return make_solver(default_solver_name(scene))


def is_installed(kind: str) -> bool:
    """Return whether the package that a solver needs, if any, is installed."""
    return kind not in REQUIRED_PACKAGES or find_spec(REQUIRED_PACKAGES[kind]) is not None


def package_version(kind: str) -> str:
    """Return the version of the package that a solver needs beside contactsim; empty if it needs none."""
    return metadata.version(REQUIRED_PACKAGES[kind]) if kind in REQUIRED_PACKAGES else ""


def check_installed(kind: str) -> None:
    """Raise InputError if the package that a solver needs is not installed."""
    if not is_installed(kind):
        raise InputError("solver", kind, f"one that is installed: pip install {REQUIRED_PACKAGES[kind]}")


def configure_solver(kind: str, **options: object) -> Any:
    """Return a solver with its options, whether or not the package that it needs is installed.

    Parameters
    ----------
    kind
        One of `SOLVERS`.
    options
        Fields of the solver's class.

    Returns
    -------
    HardWallSolver or CohesiveSolver
        The one or the other, by the kind of problem that it solves.

    Raises
    ------
    InputError
        If there is no such solver, or an option has a value that is not allowed.
    """
    return solver_class(kind)(**options)


def make_solver(kind: str, **options: object) -> Any:
    """Return a solver that can run; see `configure_solver`.

    Raises
    ------
    InputError
        As there, and if a package is missing.
    """
    solver = configure_solver(kind, **options)
    check_installed(kind)
    return solver
