"""Slides of smooth laws over a lattice that get harder: from severity 0 to 100, and what is right at each.

Where bodies are stiff against the springs nothing slips, and the fixed point of insertion is exact; soft probes stick
and slip, and are held against damped dynamics in smaller increments.
"""

from __future__ import annotations

import numpy as np

from contactsim.contact.loading import LoadPath, approaches, pressures
from contactsim.contact.scene import Body, Scene
from contactsim.contact.steps import LoadStep
from contactsim.elasticity.layer import Layer
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.interface.cohesive_zone import CohesiveZone
from contactsim.interface.lattice import Lattice
from contactsim.interface.pairing import Pairing
from contactsim.status import Status
from contactsim.surfaces.shapes import Cylinder, Flat
from contactsim.traits import Trait

LENGTH, RADIUS, RATIO, LATTICE = 1000.0, 2500.0, 0.45, 2.44140625
"""The probe of Chapter 6, a fifth of it in all directions, over the lattice of that chapter; nm."""
STRESS = 70.0 / (1 - RATIO**2)
SOFT, STIFF = Layer(STRESS, RATIO, LENGTH), Layer(STRESS, RATIO, 20.0)
STRONG, WEAK = CohesiveZone(2.0, 1.0), CohesiveZone(0.1, 1.0)
ONSET = 8.1
"""Slide at which the soft probe first slips at first touch, nm: between 7.9 and 8.3 on 64 points."""


def _probe(path: LoadPath, law: CohesiveZone, body: Layer, pairing: Pairing | None = None) -> Scene:
    surface = Cylinder(length=LENGTH, radius=RADIUS)
    return Scene(Body(Flat.facing(surface)), Body(surface, body), (law,), path, pairing or Lattice(LATTICE))


def _slide_path(slides: list[float], approach: float = 0.0) -> LoadPath:
    """Return a path that presses to an approach, then slides along x to each of the distances, nm."""
    pressing = approaches([-6.0, approach])
    sliding = [LoadStep(Trait.SLIDE, value, held=pressing.steps[-1]) for value in slides]
    return pressing >> LoadPath(tuple(sliding))


def many_cells_slid(severity: float) -> PathCase:
    """A stiff probe put down 1 to 1e6 cells of the lattice on slides by a quarter: exact, forces repeat themselves."""
    cells = round(10 ** (6 * severity / 100))
    (touching,) = approaches([0.0]).steps
    steps = [LoadStep(Trait.SLIDE, (cells + part) * LATTICE, held=touching) for part in (0.0, 0.25)]
    return PathCase(_probe(LoadPath(tuple(steps)), WEAK, STIFF), 64, even=False)


def fine_lattice(severity: float) -> PathCase:
    """The lattice gets finer, from 2.4 to 0.02 tangential lengths, at one strength: exact, friction dies out."""
    lattice = LATTICE * 0.01 ** (severity / 100)
    pairing = Lattice(lattice, weight=min(lattice / 1.77, 1.0))
    return PathCase(_probe(_slide_path([0.3 * lattice, 3.3 * lattice]), WEAK, STIFF, pairing), 64, even=False)


def wide_window(severity: float) -> PathCase:
    """The window grows from 5 to 5000 tangential lengths, five times the period: exact, far springs are nothing."""
    pairing = Lattice(LATTICE, tangential_cutoff=5 * 1e3 ** (severity / 100))
    return PathCase(_probe(_slide_path([0.6, 5.0]), WEAK, STIFF, pairing), 64, even=False)


def pulled_apart_slide(severity: float) -> PathCase:
    """Held ever farther apart, from 1 to 21 nm before first touch, the soft probe slides: as in small increments."""
    approach = -1.0 - 20 * severity / 100
    return PathCase(_probe(_slide_path([2.0, 4.0], approach), STRONG, SOFT), 64, begin=-30.0, parts=8, even=False)


def pulled_off_slide(severity: float) -> PathCase:
    """A stiff probe under 85 to 55 % of what tears it off slides by half a cell, where half as much does: it comes off.

    The pull is that of a rigid probe, by quadrature.
    """
    surface = -Cylinder(length=LENGTH, radius=RADIUS).heights(64)
    offsets = np.linspace(0.0, 2.0, 2001)
    pulls = WEAK.work_of_separation * ((surface[:, None] + offsets) * np.exp(-surface[:, None] - offsets)).mean(0)
    (pull,) = pressures([-(0.85 - 0.3 * severity / 100) * pulls.max()]).steps
    path = approaches([-6.0, -1.0]) >> LoadPath((pull, LoadStep(Trait.SLIDE, 0.5 * LATTICE, held=pull)))
    return PathCase(_probe(path, WEAK, STIFF), 64, ends=Status.NO_EQUILIBRIUM, even=False)


def pressed_through_slide(severity: float) -> PathCase:
    """Flat bodies slide under 1 to 100 % of the law's strength, until slip has taken all repulsion: no state is left.

    A coupled law then lets the bodies pass through each other.
    """
    (load,) = pressures([0.01 * WEAK.strength * 100 ** (severity / 100)]).steps
    path = LoadPath((load, *(LoadStep(Trait.SLIDE, slide, held=load) for slide in (2.0, 4.0, 12.0))))
    scene = Scene(Body(Flat(LENGTH)), Body(Flat(LENGTH), SOFT), (WEAK,), path)
    return PathCase(scene, 64, ends=Status.NO_EQUILIBRIUM, even=False)


def reversal_near_a_slip(severity: float) -> PathCase:
    """The slide turns ever closer before its first slip, then ever farther after: as in small increments."""
    turn = ONSET + (-0.5 + 0.4 * severity / 50 if severity < 50 else 0.3 + 1.7 * (severity - 50) / 50)
    path = _slide_path([4.0, 7.0, turn, 7.0, 4.0])
    return PathCase(_probe(path, STRONG, SOFT), 64, parts=6, even=False)


def large_increments(severity: float) -> PathCase:
    """Increments of the slide grow from 0.5 to 6 nm, more than two cells of the lattice: as in small ones."""
    increment = 0.5 * 12 ** (severity / 100)
    slides = [ONSET - increment / 2 + increment * step for step in range(2)]
    return PathCase(_probe(_slide_path(slides), STRONG, SOFT), 64, parts=16, even=False)


SLIDING = (
    many_cells_slid,
    fine_lattice,
    wide_window,
    pulled_apart_slide,
    pulled_off_slide,
    pressed_through_slide,
    reversal_near_a_slip,
    large_increments,
)
"""In the order of the map."""
