"""The studies that the example of the bundle analyses, on few points."""

from __future__ import annotations

import yaml

from contactsim.study.study import Study
from support.places import ROOT

PROJECT = (
    "CITATION.cff",
    "LICENSE",
    "environment.txt",
    "environment.lock.txt",
    "Snakefile",
    "examples/reanalyse.py",
    "config/ch3.yaml",
)
SMALL = {
    "ch3": {
        "rough_line": {
            "surface": {"short_cutoff": 1250.0},
            "vary": {"surface.hurst_exponent": [0.2, 0.8]},
            "load": {"reduced_pressure": [0.01, 0.03, 0.1, 0.5]},
            "points": 2048,
            "members": 3,
        }
    },
    "ch5": {
        "rough_adhesive": {
            "surface": {"short_cutoff": 160.0},
            "vary": {"normal_cohesive_zone.work_of_separation": [0.07, 0.7]},
            "path": {"approach": [-4.0, 8.0], "increment": 1.0},
            "increments": {"full_grid_at": [-2.0, 0.0, 4.0, 8.0]},
            "snapshots": [0.0, 8.0],
            "snapshot_members": 2,
            "points": 1024,
            "members": 2,
            "tolerance": 1.0e-5,
        }
    },
}
"""The studies that the example analyses, of Chapters 3 and 5, on few points."""


def small_section(chapter, name):
    """A study of the config, as it is written, with what is small about it."""
    section = yaml.safe_load((ROOT / f"config/{chapter}.yaml").read_text(encoding="utf-8"))["studies"][name]
    for key, value in SMALL[chapter][name].items():
        section[key] = section[key] | value if key in ("surface", "path", "increments") else value
    return section | {"coarse_grid": {"points": section["points"] // 2, "members": 1}}


def small(chapter, name):
    """The same, without other runs to measure errors by."""
    section = small_section(chapter, name)
    for key in ("coarse_grid", "tight_tolerance", "thesis_points", "fit_limits"):
        section.pop(key, None)
    return Study.read(name, section, f"config/{chapter}.yaml", 1)
