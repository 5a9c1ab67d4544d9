"""Scenes of all kinds that are solved to an accuracy."""

from __future__ import annotations

import contactsim as cs
from contactsim.paths.options import Setup
from contactsim.study.study import Study

LINE_SCENE = {
    "surface": {
        "kind": "self_affine",
        "hurst_exponent": 0.8,
        "length": 1024.0,
        "long_cutoff": 256.0,
        "short_cutoff": 8.0,
        "rms_gradient": 0.1,
    },
    "body": {"kind": "half_space", "contact_modulus": 1.0},
    "effects": ["hard_wall"],
    "load": {"reduced_pressure": [0.02, 0.1]},
    "accuracy": 0.02,
}
ASPERITY = {
    "surface": {"kind": "cylinder", "radius": 10000.0, "length": 4000.0},
    "body": {"kind": "layer", "youngs_modulus": 70.0, "poisson_ratio": 0.3, "thickness": 2000.0},
    "effects": ["cohesive_zone"],
    "cohesive_zone": {"work_of_separation": 1.0},
    "path": {"approach": [-6.0, 5.0]},
    "accuracy": 0.03,
}


SPHERE = cs.Sphere(500.0, 2000.0)
ZONE = cs.NormalCohesiveZone(0.05, 1.0)
CYCLE = cs.approaches([-5.0, 2.0, -9.0], 1.0, from_touch=True)
ROUGH = cs.SelfAffine(512.0, 0.8, 256.0, 64.0, rms_height=5.0, dimensions=2, seed=3)
WAVE = cs.Sinusoid(100.0, 0.5)
SOFT = cs.HalfSpace(1.0)
SCENES = {
    "sphere": cs.Scene(SOFT, SPHERE, ZONE, CYCLE),
    "layer": cs.Scene(cs.Layer(0.75, 0.45, 200.0), SPHERE, ZONE, CYCLE),
    "load": cs.Scene(SOFT, SPHERE, ZONE, cs.pressures([1e-4, 4e-4], 1e-4)),
    "rough": cs.Scene(SOFT, ROUGH, ZONE, cs.approaches([-4.0, 4.0], 1.0, from_touch=True)),
    "wave": cs.Scene(SOFT, WAVE, cs.HardWall(), cs.pressures([2e-3, 8e-3])),
    "adhesive wave": cs.Scene(SOFT, WAVE, cs.NormalCohesiveZone(1e-3, 1.0), cs.pressures([2e-3, 8e-3])),
}


def study(section: dict, **more: object) -> Study:
    return Study.read("one", {"title": "One"} | section | more, "file", 1)


def setup_of(section: dict, **more: object) -> Setup:
    return study(section, **more).runs()[0].setup


SLIDE = cs.Scene(
    cs.HalfSpace(80.0, 0.35),
    cs.Cylinder(16000.0, 4000.0),
    cs.CohesiveZone(1.2, 0.8, 1.0, 1.0),
    cs.approaches([-2.0, 5.0], 0.5) >> cs.sliding([0.0, 10.0], 0.5, approach=5.0),
)
LINE = cs.SelfAffine(1024.0, 0.8, 256.0, 8.0, rms_gradient=0.1, seed=2)
ROUND = cs.Cylinder(8000.0, 1e4)
JUMPS = cs.NormalCohesiveZone(work_of_separation=0.05, normal_length=0.5)
SCENES |= {
    "rough line": cs.Scene(SOFT, LINE, cs.HardWall(), cs.pressures([2e-3, 1e-2])),
    "thin layer": cs.Scene(cs.Layer(0.75, 0.45, 20.0), LINE, cs.HardWall(), cs.pressures([1e-2])),
    "free sphere": cs.Scene(cs.FreeHalfSpace(1.0), SPHERE, cs.HardWall(), cs.pressures([5e-4])),
    "cylinder": cs.Scene(SOFT, ROUND, JUMPS, cs.approaches([-9.0, 8.0], 0.1)),
    "slide": SLIDE,
}


CYLINDER = cs.Scene(
    cs.HalfSpace(1.0),
    cs.Cylinder(8000.0, 1e4),
    cs.NormalCohesiveZone(work_of_separation=0.05, normal_length=0.5),
    cs.approaches([-9.0, 8.0], 0.1),
)
