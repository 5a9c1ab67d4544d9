"""The house stands: modules import only those listed above them, and nothing below a law names one."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from contactsim.provenance import PACKAGE, imports_of, package_root

ORDER = """
standby errors files traits grid roughness surface self_affine scans measured topography surfaces
plane_strain symbols elasticity fields laws superposition pairing loading scene wall interface
solvers.base solvers solvers.continuation solvers.active_set solvers.polonsky_keer
solvers.verlet solvers.tamaas solvers.kernels solvers.refinement solvers.preconditioner solvers.conjugate_gradients
solvers.equilibrium solvers.krylov solvers.zone solvers.newton solvers.damped_verlet
solvers.energy_minimisation solvers.predictor walk adaptive nested follow leaving_out
observables adhesion sliding analytic provenance validity variables dataset extrapolation ensemble
hysteresis area_load peeling onset config schema build relations choice forecast study
tabulate branch loads march fits aggregate confirm effect_maps
negligible costs joblog outlook takes effect_survey findings claims api
hazards.cases hazards.lines hazards.surfaces hazards.paths hazards.adhesive hazards.rough hazards.sliding hazards
verdicts wall_verdicts path_verdicts stability figure_config plan ladder compare crate bundle explain
priced accuracy_case cost precision draws calibration regression trials budget
figures figures.notation figures.style figures.maps figures.resolution figures.stress figures.load_curves
figures.rough_curves figures.interfaces figures.thicknesses figures.factors figures.asperities figures.ch2 figures.ch3
figures.ch4 figures.ch5 figures.slide_curves figures.ch6 figures.stability figures.render figures.claims figures.knobs
figures.accuracy figures.sketch
figures.effects figures.trials figures.effect_maps figures.overview gallery rulegraph report cli
""".split()
"""Modules in import order: each may import those before it."""

ROOT = Path(__file__).parents[1]


def modules() -> list[str]:
    files = package_root().rglob("*.py")
    names = [".".join(file.relative_to(package_root()).with_suffix("").parts) for file in files]
    return [name.removesuffix(".__init__") for name in names if name != "__init__"]


def test_every_module_has_its_place():
    assert sorted(modules()) == sorted(ORDER)


@pytest.mark.parametrize("name", ORDER)
def test_a_module_imports_only_those_above_it(name):
    above = ORDER[: ORDER.index(name)]
    imported = {module.removeprefix(f"{PACKAGE}.") for module in imports_of(f"{PACKAGE}.{name}")}
    assert imported - {PACKAGE, name} <= set(above)


@pytest.mark.parametrize("name", [name for name in ORDER if name.startswith(("solvers", "figures"))])
def test_no_solver_and_no_figure_names_a_law(name):
    assert f"{PACKAGE}.laws" not in imports_of(f"{PACKAGE}.{name}")


def test_nothing_branches_on_friction_or_adhesion():
    ladder = re.compile(r"\b(el)?if\b[^:\n]*\b(friction|adhesi(on|ve)|cohesive)\b")
    for file in package_root().rglob("*.py"):
        assert not ladder.search(file.read_text(encoding="utf-8")), file


@pytest.mark.parametrize("folder", ["workflow/scripts"])
def test_scripts_are_thin(folder):
    for file in (ROOT / folder).glob("*.py"):
        assert len(file.read_text(encoding="utf-8").splitlines()) <= 20, file


def test_only_the_dataset_module_writes_result_files():
    for name in ORDER:
        if name not in ("dataset", "measured"):
            path = package_root().joinpath(*name.split("."))
            text = (path / "__init__.py" if path.is_dir() else path.with_suffix(".py")).read_text(encoding="utf-8")
            assert "to_netcdf" not in text, name
            assert "load_dataset" not in text, name


def test_the_readme_shows_every_module():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for name in ORDER:
        assert re.search(rf"\b{name.rpartition('.')[2]}\b", text), name


def rules() -> dict[str, str]:
    """The text of each rule that has a script, by the script's name."""
    found = {}
    for file in sorted((ROOT / "workflow/rules").glob("*.smk")):
        for text in re.split(r"^ *rule ", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            named = re.search(r'script: "\.\./scripts/(\w+\.py)"', text)
            if named:
                found[named[1]] = text
    return found


def test_every_script_has_a_rule():
    assert set(rules()) == {file.name for file in (ROOT / "workflow/scripts").glob("*.py")}


@pytest.mark.parametrize("script", sorted(rules()))
def test_a_script_asks_for_nothing_that_its_rule_does_not_give(script):
    text = (ROOT / "workflow/scripts" / script).read_text(encoding="utf-8")
    own = {"input", "output", "params", "log", "wildcards", "threads", "rule"}
    for part, name in re.findall(r"snakemake\.(\w+)(?:\.([a-z_]+)\b(?!\())?", text):
        assert part in own
        if name and part != "wildcards":
            given = re.search(
                rf"\b{part}:(.*?)^ *(?!{part})[a-z]+:", rules()[script] + "\nend:", re.DOTALL | re.MULTILINE
            )
            assert re.search(rf"\b{name}=", given[1]), (part, name)
