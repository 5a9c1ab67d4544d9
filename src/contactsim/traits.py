"""Traits: demands of a scene on a solver.

A scene derives its traits from what it lists; a solver declares those it accepts.
A scene is refused unless every one of its traits is accepted, and the refusal names the first that is not.
"""

from __future__ import annotations

from enum import Enum


class Trait(Enum):
    """One property of a scene; its value is the sentence a refusal quotes."""

    LINE = "line contact: surfaces vary along one direction"
    SURFACE = "surface contact: surfaces vary along two directions"
    WALL = "hard wall: the gap is never negative, the pressure never pulls"
    ADHESIVE_WALL = "hard wall beside smooth laws: the gap is never negative, and what pulls is a function of it"
    SMOOTH = "smooth law: traction is a function of the gap"
    NON_CONSERVATIVE = "a law without a potential: there is no energy to minimise"
    HALF_SPACE = "half-space: the mean displacement is free, so the uniform mode has no stiffness"
    FREE = "free half-space: nothing repeats beyond the ends of the heights"
    LAYER = "layer on a rigid base: long waves meet a stiffness that depends on thickness and Poisson's ratio"
    MEAN_PRESSURE = "load step given by a mean pressure"
    APPROACH = "load step given by an approach"
    SLIDE = "load step given by a displacement along the surfaces"
