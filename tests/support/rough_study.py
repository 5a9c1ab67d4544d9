"""A study of rough lines with some values changed, and how it is read, refused and executed."""

from __future__ import annotations

from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest

from contactsim.errors import InputError
from contactsim.study import execute
from contactsim.study.execute import RunFiles
from contactsim.study.run import Run
from contactsim.study.study import Study

ROUGH = {
    "title": "Rough line",
    "surface": {
        "kind": "self_affine",
        "hurst_exponent": 0.8,
        "length": 64.0,
        "long_cutoff": 32.0,
        "short_cutoff": 4.0,
        "rms_gradient": 0.01,
    },
    "body": {"kind": "half_space", "contact_modulus": 2.0},
    "effects": ["hard_wall"],
    "load": {"reduced_pressure": [0.1, 0.01]},
    "vary": {"surface.hurst_exponent": [0.2, 0.8], "surface.long_cutoff": [16.0, 24.0, 32.0]},
    "points": 128,
    "members": 2,
    "coarse_grid": {"points": 64, "members": 1},
    "tolerance": 1e-3,
}
SURFACES = {
    "flat": {"kind": "flat", "length": 64.0},
    "cylinder": {"kind": "cylinder", "length": 64.0, "radius": 100.0},
    "sinusoid": {"kind": "sinusoid", "length": 64.0, "amplitude": 1.0, "periods": 2},
}
GONE = object()


def changed(changes: dict) -> dict:
    """The rough study with some values changed: dotted keys to values, GONE to take one away."""
    section = deepcopy(ROUGH)
    for dotted, value in changes.items():
        *path, last = dotted.split("/")
        inner = section
        for name in path:
            inner = inner[name]
        if value is GONE:
            del inner[last]
        else:
            inner[last] = value
    return section


def study(changes: dict | None = None, seed: int = 1) -> Study:
    """Return the changed study as read."""
    return Study.read("rough", changed(changes or {}), "ch9.yaml", seed)


def smooth(kind: str, load: dict, **changes: object) -> Study:
    """Return the study of one smooth surface."""
    return study({"surface": SURFACES[kind], "load": load, "vary": {}, "members": 1, "coarse_grid": GONE} | changes)


def refusal(changes: dict) -> InputError:
    """Return the error by which a changed study is refused."""
    with pytest.raises(InputError) as caught:
        study(changes)
    return caught.value


WALKED = {
    "effects": ["normal_cohesive_zone"],
    "normal_cohesive_zone": {"work_of_separation": 1.0},
    "load": GONE,
    "path": {"approach": [-5.0, -4.0], "increment": 0.5},
}
"""Changes that make it a path of a smooth law."""


def executed(study: Study, folder: Path) -> list[dict]:
    """Execute all runs of a study; return them as aggregation wants them."""
    names, runs = ("coordinates", "member", "measures_error"), []
    for number, run in enumerate(study.runs()):
        path = folder / f"{number}.nc"
        execute.run(run.settings, "source", RunFiles(path, path.with_suffix(".json")))
        runs.append({"path": path} | {name: getattr(run, name) for name in names})
    return runs


def profile(run: Run) -> np.ndarray:
    """Return the heights of a run."""
    return run.setup.scene.upper.surface.heights(run.setup.points)
