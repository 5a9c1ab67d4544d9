"""Scenes of smooth laws, small ones of Chapter 4's kind, and one-line ways through them; shared by several tests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contactsim.contact.cohesive import CohesiveProblem
from contactsim.contact.loading import LoadPath, approaches
from contactsim.contact.pose_cohesive import pose_cohesive
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.layer import Layer
from contactsim.interface.base import Law
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.observables.adhesion import state_observables
from contactsim.paths.requested import Requested
from contactsim.paths.state import PathState
from contactsim.solvers.registry import make_solver
from contactsim.surfaces.base import Surface
from contactsim.surfaces.shapes import Cylinder, Flat

LENGTH, RADIUS = 10000.0, 25000.0
LAYER = Layer(70.0 / (1 - 0.3**2), 0.3, 5000.0)
LAWS = {
    "uncoupled": NormalCohesiveZone(2.0),
    "frictionless": CohesiveZone(2.0),
    "frictional": CohesiveZone(2.0, 1.0),
    "uncoupled_frictional": UncoupledCohesiveZone(2.0, 1.0),
}


def scene_of(
    law: Law,
    path: LoadPath | None = None,
    lower: Elasticity | None = LAYER,
    upper: Elasticity | None = None,
    surface: Surface | None = None,
) -> Scene:
    """A cylinder, or another surface, above an elastic body."""
    surface = surface or Cylinder(length=LENGTH, radius=RADIUS)
    return Scene(Body(Flat.facing(surface), lower), Body(surface, upper), (law,), path or approaches([0.0]))


@dataclass(frozen=True)
class Walked:
    """A path through a scene: its problem, its states, and their loads (N/m)."""

    problem: CohesiveProblem
    states: list[PathState]
    load: np.ndarray

    @property
    def jumps(self) -> list[float]:
        """Where the surface jumped."""
        return [state.step.value for state in self.states if state.jump]

    @property
    def statuses(self) -> set[str]:
        """How the steps ended."""
        return {state.status.name for state in self.states}

    @property
    def transforms(self) -> float:
        """What it cost."""
        return sum(state.transforms for state in self.states)

    def gap(self, count: int = -1) -> np.ndarray:
        """The gap (components, n), nm, of a state."""
        state = self.states[count]
        return self.problem.at(state.step).gap(state.displacement)


def walk(
    scene: Scene, points: int = 256, method: object = "newton", increments: object = None, tolerance: float = 1e-7
) -> Walked:
    """Follow a scene's path."""
    problem = pose_cohesive(scene, scene.heights(points), tolerance)
    method = make_solver(method) if isinstance(method, str) else method
    states = list((increments or Requested()).follow(problem, method, scene.path.steps))
    load = []
    for state in states:
        load.append(state_observables(state.problem, *state.fields())["line_load"])
    return Walked(problem, states, np.array(load))


def along(begin: float, end: float, increment: float) -> LoadPath:
    """Approaches from one to another, both inclusive."""
    return approaches(np.linspace(begin, end, round(abs(end - begin) / increment) + 1).round(9).tolist())


def residual_of(problem: CohesiveProblem, displacement: np.ndarray) -> float:
    """Return the largest |K v + T| at any point over the laws' strength, from the displacement alone."""
    return problem.norm(problem.residual(displacement, problem.traction(problem.gap(displacement))))
