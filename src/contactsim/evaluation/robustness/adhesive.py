"""Paths of smooth adhesive laws that get harder: from severity 0 to 100, and what is right at each."""

from __future__ import annotations

import numpy as np

from contactsim.contact.loading import LoadPath, approaches, pressures
from contactsim.contact.scene import Body, Scene
from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.evaluation.robustness.cases import nearly_incompressible_ratio
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.interface.base import Law
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone
from contactsim.status import Status
from contactsim.surfaces.shapes import Cylinder, Flat

LENGTH, RADIUS, MODULUS, RATIO = 5000.0, 25000.0, 70.0, 0.3
"""Chapter 4's cylinder on half its period; Young's modulus and Poisson's ratio of the body below it; nm, GPa."""
STRESS = MODULUS / (1 - RATIO**2)
BODY = Layer(STRESS, RATIO, LENGTH)


def _cylinder(
    law: Law,
    path: LoadPath,
    lower: Elasticity = BODY,
    upper: Elasticity | None = None,
    length: float = LENGTH,
) -> Scene:
    surface = Cylinder(length=length, radius=RADIUS)
    return Scene(Body(Flat.facing(surface), lower), Body(surface, upper), (law,), path)


def strong_adhesion(severity: float) -> PathCase:
    """Adhesion with friction gets stronger, φn/(δn E) from 0.01 to 0.15: the branch is that of smaller increments."""
    law = CohesiveZone(MODULUS * (0.01 + 0.14 * severity / 100), 1.0)
    return PathCase(_cylinder(law, approaches([-7.0, 5.0]), length=2500.0), begin=-14.0, parts=3)


def coarse_process_zone(severity: float) -> PathCase:
    """Grid spacings per process zone e²E*δn²/φn rise from 0.2 to 4: what the grid can tell is solved."""
    work = np.e**2 * STRESS * 128 / LENGTH * 0.2 * 20 ** (severity / 100)
    return PathCase(_cylinder(NormalCohesiveZone(work), approaches([5.0])))


def short_range(severity: float) -> PathCase:
    """The law gets shorter, δn from 1 to 0.1 nm, and so stiffer: the branch is that of smaller increments."""
    length = 10 ** (-severity / 100)
    law = NormalCohesiveZone(0.1, length)
    return PathCase(_cylinder(law, approaches([-5.0, 1.0, 5.0]), length=2500.0), 256, begin=-6.0, parts=4)


def deep_step(severity: float) -> PathCase:
    """One step from apart to 1, then 100 characteristic lengths beyond touch: the state is that of many small ones."""
    depth = 100 ** (severity / 100)
    return PathCase(_cylinder(NormalCohesiveZone(2.0), approaches([depth])), parts=round(8 + depth / 8))


def deep_path(severity: float) -> PathCase:
    """Two steps to 6, then 60 characteristic lengths beyond touch, without friction: as with four times as many."""
    depth = 6 * 10 ** (severity / 100)
    path = approaches([depth / 2, depth])
    return PathCase(_cylinder(CohesiveZone(2.0), path), begin=0.0, parts=4)


def vanishing_adhesion(severity: float) -> PathCase:
    """The work of separation falls from 2 to 1e-12 N/m, to no contact: exact where insertion contracts."""
    law = CohesiveZone(2.0 * 5e-13 ** (severity / 100))
    return PathCase(_cylinder(law, approaches([-5.0, 1.0])), parts=6)


def strong_friction(severity: float) -> PathCase:
    """The tangential work of separation rises from 1 to 100 times the normal one: as in smaller increments."""
    law = CohesiveZone(2.0, 100 ** (severity / 100))
    return PathCase(_cylinder(law, approaches([-7.0, -4.0])), parts=2)


def incompressible_body(severity: float) -> PathCase:
    """In a layer a tenth as thick as the period, ν rises from 0.3 to exactly 0.5: the volume is kept."""
    ratio = nearly_incompressible_ratio(severity)
    body = Layer(STRESS, ratio, LENGTH / 10)
    return PathCase(_cylinder(CohesiveZone(2.0, 0.1), approaches([5.0]), body), parts=8)


def layer_thickness(severity: float) -> PathCase:
    """A layer gets thicker, from 1e-3 to 1e3 periods: springs, then a base that gives way; as in small increments."""
    body = Layer(STRESS, RATIO, LENGTH * 10 ** (-3 + 6 * severity / 100))
    return PathCase(_cylinder(CohesiveZone(2.0), approaches([0.0, 5.0]), body), parts=3)


def sudden_jump(severity: float) -> PathCase:
    """Both jumps, into contact and out again, in one step each, of 2 to 80 nm: as in small increments."""
    far = severity / 100
    path = approaches([-7.0, -5.0 + 25 * far, -12.0 - 48 * far])
    return PathCase(_cylinder(NormalCohesiveZone(2.0), path), parts=round(8 + 16 * far))


def past_pull_off(severity: float) -> PathCase:
    """A load pulls a stiff pair short of its largest pull, then beyond it, by all of it down to a hundredth.

    The pull is that of a rigid pair, by quadrature: displacements are below a thousandth of the law's length.
    """
    law, past = NormalCohesiveZone(1e-5), 10 ** (-severity / 50)
    surface = -Cylinder(length=LENGTH, radius=RADIUS).heights(128)
    offsets = np.linspace(0.0, 2.0, 2001)
    pulls = law.work_of_separation * ((surface[:, None] + offsets) * np.exp(-surface[:, None] - offsets)).mean(0)
    path = pressures([-(1 - past / 2) * pulls.max(), -(1 + past) * pulls.max()])
    return PathCase(_cylinder(law, path, HalfSpace(STRESS, RATIO)), ends=Status.NO_EQUILIBRIUM)


def overpowering_load(severity: float) -> PathCase:
    """A load pulls with 1.1 to 1e4 times what the law could carry everywhere: bodies in contact come apart."""
    law = CohesiveZone(2.0, 1.0)
    path = pressures([0.02, -1.1 * law.strength * (1e4 / 1.1) ** (severity / 100)])
    return PathCase(_cylinder(law, path), ends=Status.NO_EQUILIBRIUM)


def alike_bodies(severity: float) -> PathCase:
    """Poisson's ratios of two bodies approach each other, by 0.03 down to none: they slip no more, as if uncoupled."""
    apart = 0.0 if severity >= 100 else 0.03 * 10 ** (-severity / 10)
    upper = Layer(STRESS, RATIO + apart, LENGTH)
    scene = _cylinder(CohesiveZone(2.0, 1.0), approaches([5.0]), upper=upper)
    return PathCase(scene, parts=8, twin=(NormalCohesiveZone(2.0),) if severity >= 20 else None)


ADHESIVE = (
    strong_adhesion,
    coarse_process_zone,
    short_range,
    deep_step,
    deep_path,
    vanishing_adhesion,
    strong_friction,
    incompressible_body,
    layer_thickness,
    sudden_jump,
    past_pull_off,
    overpowering_load,
    alike_bodies,
)
"""In the order of the map."""
