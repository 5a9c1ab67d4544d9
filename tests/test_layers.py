"""The packages stand in one order: each imports only those above it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from contactsim.code_digest import module_path, package_root, read_source
from contactsim.provenance import PACKAGE

ROOT = Path(__file__).parents[1]
FLOORS = (
    (
        "errors",
        "fft",
        "arguments",
        "durations",
        "grid",
        "traits",
        "threads",
        "files",
        "status",
        "variables",
        "dataset",
        "provenance",
        "seals",
        "reference",
        "code_digest",
    ),
    ("topography_files",),
    ("surfaces",),
    ("elasticity",),
    ("interface",),
    ("contact",),
    ("solvers",),
    ("observables",),
    ("paths",),
    ("error_control",),
    ("simulation", "single_load", "characterisation", "explanation"),
    ("analysis",),
    ("study",),
    ("evaluation",),
    ("figures",),
    ("publish",),
    ("scene_files",),
    ("commands",),
    ("press_command",),
    ("cli",),
)
"""Packages from the ground up: each may import itself and those before it; modules of one floor may share."""
LIBRARY = (
    "topography_files",
    "surfaces",
    "elasticity",
    "interface",
    "contact",
    "solvers",
    "observables",
    "paths",
    "error_control",
)


def rooms() -> dict[str, set[str]]:
    """Modules by the package or top-level module that they belong to."""
    found: dict[str, set[str]] = {}
    for file in package_root().rglob("*.py"):
        parts = file.relative_to(package_root()).with_suffix("").parts
        if parts != ("__init__",):
            name = ".".join(parts).removesuffix(".__init__")
            found.setdefault(parts[0], set()).add(name)
    return found


def imports_of(module: str) -> frozenset[str]:
    """Modules of this package that a module imports, for types too."""
    _, executed, for_types = read_source(module_path(module))
    return executed | for_types


def imported_rooms(room: str) -> dict[str, set[str]]:
    """Rooms that a room imports, each with the modules that do."""
    found: dict[str, set[str]] = {}
    for module in rooms()[room]:
        for name in imports_of(f"{PACKAGE}.{module}"):
            found.setdefault(name.split(".")[1], set()).add(module)
    return found


def test_every_package_has_its_floor():
    assert sorted(rooms()) == sorted(room for floor in FLOORS for room in floor)


@pytest.mark.parametrize("room", [room for floor in FLOORS for room in floor])
def test_a_package_imports_only_those_above_it(room):
    floor = next(number for number, names in enumerate(FLOORS) if room in names)
    allowed = {name for names in FLOORS[: floor + 1] for name in names}
    assert {name: modules for name, modules in imported_rooms(room).items() if name not in allowed} == {}


@pytest.mark.parametrize("room", ["solvers", "figures"])
def test_no_solver_and_no_figure_names_an_effect(room):
    effects = {f"{PACKAGE}.interface.{name}" for name in ("hard_wall", "cohesive_zone", "registry")}
    for module in rooms()[room]:
        assert not effects & imports_of(f"{PACKAGE}.{module}"), module


def test_nothing_branches_on_friction_or_adhesion():
    ladder = re.compile(r"\b(el)?if\b[^:\n]*\b(friction|adhesi(on|ve)|cohesive)\b")
    for file in package_root().rglob("*.py"):
        assert not ladder.search(file.read_text(encoding="utf-8")), file


def test_scripts_are_thin():
    for file in (ROOT / "workflow/scripts").glob("*.py"):
        assert len(file.read_text(encoding="utf-8").splitlines()) <= 20, file
