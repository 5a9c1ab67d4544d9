from __future__ import annotations

import ast
import shutil
from pathlib import Path

import pytest

import contactsim
from contactsim import code_digest
from contactsim.code_digest import module_path, modules_used, read_source, source_digest
from contactsim.solvers.registry import SOLVERS, solver_module

SOURCE = Path(contactsim.__file__).parent
MODULES = sorted(
    ".".join(("contactsim", *path.relative_to(SOURCE).with_suffix("").parts)).removesuffix(".__init__")
    for path in SOURCE.rglob("*.py")
)


def forget():
    for cached in (read_source, source_digest):
        cached.cache_clear()


def imported_names(module):
    """Dotted names of all that a module imports from this package, members among them."""
    nodes = [node for node in ast.walk(ast.parse(module_path(module).read_text())) if isinstance(node, ast.ImportFrom)]
    return {f"{node.module}.{alias.name}" for node in nodes for alias in node.names}


def imports_of(module):
    return read_source(module_path(module))[1]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A copy of the package, whose modules are taken for those of the package itself."""
    copy = tmp_path / "contactsim"
    shutil.copytree(SOURCE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(code_digest, "package_root", lambda: copy)
    forget()
    yield copy
    forget()


def write(package, **texts):
    for name, text in texts.items():
        (package / f"{name}.py").write_text(text, encoding="utf-8")
    forget()


def test_running_a_study_uses_its_direct_and_indirect_imports_but_no_figure_and_no_solver():
    used = modules_used("contactsim.study.execute")
    assert {
        "contactsim.study.execute",
        "contactsim.grid",
        "contactsim.surfaces.topography",
        "contactsim.solvers.base",
    } <= set(used)
    assert not [name for name in used if "figures" in name]
    assert not set(map(solver_module, SOLVERS)) & set(used)
    assert "contactsim.analysis.aggregate" not in used
    assert list(used) == sorted(used)


def test_running_with_a_solver_uses_that_solver_only():
    solvers = set(map(solver_module, SOLVERS))
    for module in solvers:
        assert solvers & set(modules_used("contactsim.study.execute", module)) == {module}


def test_other_packages_and_the_bare_package_are_no_modules_used():
    for name in MODULES[1:]:
        assert set(modules_used(name)) <= set(MODULES[1:])


def test_every_import_in_the_package_is_one_that_is_followed():
    # Relative imports would be missed, and so would a module named only in a string: solvers are, and are added.
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            assert not (isinstance(node, ast.ImportFrom) and node.level), f"relative import in {path}"


def test_imports_of_every_form_and_at_any_depth_are_found(package):
    write(
        package,
        one="import contactsim.grid\nimport numpy.linalg\nx = contactsim.grid\n",
        two="from contactsim import one, InputError\nfrom contactsim.solvers import base\nx = one, base\n",
        three="def f():\n    if True:\n        from contactsim.two import x as other\n",
    )
    assert imports_of("contactsim.one") == {"contactsim.grid"}
    assert imports_of("contactsim.two") == {*("contactsim.one", "contactsim.solvers", "contactsim.solvers.base")}
    assert imports_of("contactsim.three") == {"contactsim.two"}
    assert {"contactsim.one", "contactsim.two", "contactsim.grid"} < set(modules_used("contactsim.three"))


def test_modules_that_import_each_other_are_used_once(package):
    write(package, one="import contactsim.two\nx = contactsim.two\n", two="import contactsim.one\ny = contactsim.one\n")
    assert modules_used("contactsim.one") == ["contactsim.one", "contactsim.two"]


def test_the_digest_changes_with_what_a_used_module_computes_and_with_nothing_else(package):
    write(package, one="from contactsim.two import x\ny = x\n", two="x = 1\n", three="x = 1\n")
    before = source_digest("contactsim.one")
    write(package, three="x = 2\n")
    assert source_digest("contactsim.one") == before
    write(package, two="x = 1  # said better\n", one='"""One."""\n\nfrom contactsim.two import x\n\ny = x\n')
    assert source_digest("contactsim.one") == before
    write(package, two="x = 2\n")
    assert source_digest("contactsim.one") != before


def test_the_digest_changes_when_code_moves_from_one_module_to_another(package):
    write(package, one="from contactsim.two import y\nx = 1\nz = y\n", two="y = 1\n")
    before = source_digest("contactsim.one")
    write(package, one="from contactsim.two import y\nz = y\n", two="x = 1\ny = 1\n")
    assert source_digest("contactsim.one") != before


def test_no_module_of_the_package_imports_its_public_names_from_the_bare_package():
    # These are loaded when they are used, so following imports would not find them.
    for module in MODULES[1:]:
        from_package = {name for name in imported_names(module) if name.count(".") == 1}
        bare = {name for name in from_package if name.startswith("contactsim.") and module_path(name) is None}
        assert bare == set(), module


def test_the_digest_does_not_depend_on_the_order_or_the_place_of_the_package(package, monkeypatch):
    here = source_digest("contactsim.study.execute", "contactsim.solvers.hard_wall.verlet")
    assert here == source_digest("contactsim.solvers.hard_wall.verlet", "contactsim.study.execute", "contactsim.grid")
    package.rename(package.with_name("moved"))
    moved = package.with_name("moved")
    monkeypatch.setattr(code_digest, "package_root", lambda: moved)
    forget()
    assert source_digest("contactsim.study.execute", "contactsim.solvers.hard_wall.verlet") == here
    assert len(here) == 16
    assert set(here) <= set("0123456789abcdef")


def test_a_copy_of_the_package_has_its_digest(package, monkeypatch):
    copied = source_digest("contactsim.study.execute")
    monkeypatch.setattr(code_digest, "package_root", lambda: SOURCE)
    forget()
    assert source_digest("contactsim.study.execute") == copied
