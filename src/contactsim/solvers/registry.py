"""The registry of solvers: config name to class.

Classes are named, not imported, so that a run loads, and depends on, only the method it uses.
"""

from __future__ import annotations

from importlib import import_module, metadata
from importlib.util import find_spec

from contactsim.contact.scene import Scene
from contactsim.errors import SceneError
from contactsim.solvers.base import Solver
from contactsim.traits import Trait

SOLVERS = {
    "active_set": "contactsim.solvers.hard_wall.active_set:NestedActiveSet",
    "polonsky_keer": "contactsim.solvers.hard_wall.polonsky_keer:PolonskyKeer",
    "verlet": "contactsim.solvers.hard_wall.verlet:WallVerlet",
    "tamaas": "contactsim.solvers.hard_wall.tamaas:Tamaas",
    "conjugate_gradients": "contactsim.solvers.hard_wall.conjugate_gradients:NestedConjugateGradients",
    "newton": "contactsim.solvers.cohesive.newton_krylov:NewtonKrylov",
    "damped_verlet": "contactsim.solvers.cohesive.damped_verlet:DampedVerlet",
    "mass_weighted_verlet": "contactsim.solvers.cohesive.damped_verlet:MassWeightedVerlet",
    "energy_minimisation": "contactsim.solvers.cohesive.energy_minimisation:EnergyMinimisation",
}
USUAL = {Trait.SMOOTH: "newton", Trait.LINE: "active_set", Trait.SURFACE: "conjugate_gradients"}
"""What is used where nothing is asked for, by the first of these traits that the scene has."""
PEERS = {"tamaas": "tamaas"}
"""Solvers that need a package which contactsim does not."""


def module_of(kind: str) -> str:
    """Name of the module in which a solver lives."""
    if kind not in SOLVERS:
        raise SceneError("solver", kind, f"one of {', '.join(sorted(SOLVERS))}")
    return SOLVERS[kind].partition(":")[0]


def solver_class(kind: str) -> type:
    """The class of a solver."""
    return getattr(import_module(module_of(kind)), SOLVERS[kind].partition(":")[2])


def usual_kind(traits: frozenset[Trait]) -> str:
    """Name of the solver for a scene of these traits where none is asked for."""
    return next(kind for trait, kind in USUAL.items() if trait in traits)


def usual(scene: Scene) -> Solver:
    """The solver for a scene where none is asked for."""
    return solver(usual_kind(scene.traits))


def installed(kind: str) -> bool:
    """Whether what a solver needs is there."""
    return kind not in PEERS or find_spec(PEERS[kind]) is not None


def peer_version(kind: str) -> str:
    """Version of the package that a solver needs beside this one; empty of others."""
    return metadata.version(PEERS[kind]) if kind in PEERS else ""


def solver(kind: str, **options: float) -> Solver:
    """The solver of that kind, with its options."""
    method = solver_class(kind)(**options)
    if not installed(kind):
        raise SceneError("solver", kind, f"one that is installed: pip install {PEERS[kind]}")
    return method
