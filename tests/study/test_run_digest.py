"""The digest of a run covers the code that it executes, and not that of other kinds."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import pytest
import yaml

from contactsim.code_digest import modules_used
from contactsim.solvers.registry import solver_module
from contactsim.study.execute import RunFiles, run
from contactsim.study.plan import Plan
from contactsim.study.run import Run, modules_of_kinds
from contactsim.study.stages import REGISTRIES, STAGES

HALF_SPACE = {"kind": "half_space", "contact_modulus": 1.0, "poisson_ratio": 0.3}
LAYER = HALF_SPACE | {"kind": "layer", "thickness": 10.0}
ROUGH = {
    "kind": "self_affine",
    "dimensions": 1,
    "hurst_exponent": 0.8,
    "length": 640.0,
    "long_cutoff": 160.0,
    "short_cutoff": 40.0,
    "rms_gradient": 0.1,
}
LAW = {"work_of_separation": 0.1, "work_ratio": 0.1, "normal_length": 1.0, "tangential_length": 1.0}
APPROACH = {"approach": [-4.0, 1.0], "increment": 0.5}
STICKY = {
    "surface": {"kind": "cylinder", "radius": 10.0, "length": 40.0},
    "body": HALF_SPACE,
    "effects": ["cohesive_zone"],
    "cohesive_zone": LAW,
    "path": APPROACH,
    "tolerance": 1e-5,
}
WALL = {"body": HALF_SPACE, "effects": ["hard_wall"], "load": {"reduced_pressure": [0.01, 0.1]}, "tolerance": 1e-3}
STUDIES = {
    "line": WALL | {"surface": ROUGH},
    "area": WALL | {"surface": ROUGH | {"dimensions": 2}},
    "slow": WALL | {"surface": ROUGH, "solver": {"kind": "polonsky_keer"}, "load": {"mean_pressure": [1e-3]}},
    "sticky": STICKY,
    "layered": STICKY | {"body": LAYER, "increments": {"kind": "adaptive"}},
    "nested": STICKY
    | {
        "surface": ROUGH,
        "increments": {"kind": "nested", "full_grid_at": [0.0], "coarse_ratio": 4, "intermediate_ratio": 2},
    },
    "sliding": STICKY
    | {
        "surface": {"kind": "sinusoid", "amplitude": 1.0, "length": 40.0},
        "body": {"kind": "rigid"},
        "counter_body": LAYER,
        "pairing": {"kind": "lattice", "lattice_constant": 2.5, "tangential_cutoff": 5.0},
        "slide": {"through": [0.0, 1.0], "increment": 0.5, "approach": 1.0},
    },
    "stiff": {name: value for name, value in STICKY.items() if name != "cohesive_zone"}
    | {
        "effects": ["stiff_cohesive_zone"],
        "stiff_cohesive_zone": {"work_of_separation": 0.1, "contact_stiffness": 1.0},
    },
}


@pytest.fixture
def runs(tmp_path: Path) -> dict[str, Run]:
    """A run of each study."""
    config = tmp_path / "config"
    config.mkdir()
    studies = {name: {"title": name, "points": 64} | settings for name, settings in STUDIES.items()}
    files = {
        "config.yaml": {"seed": 1, "tier": "plain", "results": "made"},
        "tiers.yaml": {"plain": {}},
        "ch8.yaml": {"studies": studies, "figures": {}},
    }
    for name, content in files.items():
        (config / name).write_text(yaml.safe_dump(content), encoding="utf-8")
    return {name: study.runs()[0] for name, study in Plan.read(config).studies.items()}


@contextmanager
def recorded() -> Iterator[set[str]]:
    """Record the modules of this package whose functions are called."""
    modules: set[str] = set()

    def record(frame: FrameType, event: str, argument: object) -> None:
        modules.add(str(frame.f_globals.get("__name__", "")))

    before = sys.getprofile()
    sys.setprofile(record)
    try:
        yield modules
    finally:
        sys.setprofile(before)
        for name in [name for name in modules if not name.startswith("contactsim.")]:
            modules.remove(name)


def covered(run: Run) -> set[str]:
    """Modules that the digest of a run covers."""
    named = solver_module(run.settings["solver"]["kind"]), *modules_of_kinds(run.settings)
    return set(modules_used(*STAGES["run"], *named, registries=REGISTRIES))


@pytest.mark.parametrize("name", STUDIES)
def test_a_run_executes_nothing_that_its_digest_does_not_cover(runs: dict[str, Run], name: str, tmp_path: Path) -> None:
    settings, source = runs[name].settings, runs[name].source
    with recorded() as modules:
        run(settings, source, RunFiles(tmp_path / "0.nc", tmp_path / "0.json"))
    assert "contactsim.study.execute" in modules
    assert modules <= covered(runs[name])


def test_the_digest_covers_no_other_kind(runs: dict[str, Run]) -> None:
    modules = {name: {module.removeprefix("contactsim.") for module in covered(run)} for name, run in runs.items()}
    readers = {
        "surfaces.scan_files",
        "topography_files.instrument",
        "topography_files.text_layouts",
        "topography_files.netcdf",
    }
    assert not (modules["line"] | modules["area"]) & readers  # computed surfaces read no files
    assert not modules["line"] & {"interface.cohesive_zone", "contact.cohesive", "elasticity.layer", "paths.record"}
    assert not modules["area"] & {"solvers.hard_wall.active_set", "solvers.cohesive.newton_krylov"}
    assert not modules["sticky"] & {"paths.pressures", "elasticity.layer", "interface.lattice", "paths.nested"}
    assert not modules["sliding"] & {"interface.repulsion", "paths.adaptive"}
