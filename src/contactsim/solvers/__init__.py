"""The registry of solvers: config name to class.

Classes are named, not imported, so that a run loads, and depends on, only the method it uses.
"""

from __future__ import annotations

from importlib import import_module

from contactsim.errors import SceneError
from contactsim.solvers.base import Solver

SOLVERS = {
    "active_set": "contactsim.solvers.active_set:NestedActiveSet",
    "polonsky_keer": "contactsim.solvers.polonsky_keer:PolonskyKeer",
    "verlet": "contactsim.solvers.verlet:WallVerlet",
}


def module_of(name: str) -> str:
    """Name of the module in which a solver lives."""
    if name not in SOLVERS:
        raise SceneError("solver", name, f"one of {sorted(SOLVERS)}")
    return SOLVERS[name].partition(":")[0]


def solver(name: str, **options: float) -> Solver:
    """The solver of that name, with its options."""
    module = import_module(module_of(name))
    return getattr(module, SOLVERS[name].partition(":")[2])(**options)
