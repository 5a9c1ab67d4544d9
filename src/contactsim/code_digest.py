"""Digests of the code that computes a result: the syntax trees of modules and of all that they import.

The workflow gives each job the digest of the modules that it executes, so that an edit reruns what uses it. Comments,
layout, docstrings and imports for type checking alone are no part of it.
"""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

from contactsim.provenance import PACKAGE, digest, versions


@cache
def package_root() -> Path:
    """Return the folder that holds the package's modules."""
    return Path(__file__).parent


def module_path(name: str) -> Path | None:
    """Return the file of a module of this package, None for anything else."""
    if not name.startswith(f"{PACKAGE}."):
        return None
    base = package_root().joinpath(*name.split(".")[1:])
    file = base / "__init__.py" if base.is_dir() else base.with_suffix(".py")
    return file if file.exists() else None


@cache
def read_source(path: Path) -> tuple[str, frozenset[str], frozenset[str]]:
    """Return what a file computes as text, the modules of this package that it imports, and those for types alone."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    all_imports = _imports(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            node.body = []
        elif isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):  # texts on their own do nothing
            docs = [part for part in node.body if isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant)]
            node.body = [part for part in node.body if part not in docs]
    return ast.dump(tree), _imports(tree), all_imports - _imports(tree)


def _imports(tree: ast.Module) -> frozenset[str]:
    """Return the modules of this package that are imported anywhere in a tree."""
    names: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
    return frozenset(name for name in names if module_path(name))


def modules_used(*names: str, registries: frozenset[str] = frozenset()) -> list[str]:
    """Return these modules and all that they import, directly or not, sorted.

    What registries import is left out: of the classes that they name, those in use are among `names`.
    """
    used, waiting = set(), set(names)
    while waiting:
        module = waiting.pop()
        used.add(module)
        path = None if module in registries else module_path(module)
        waiting |= read_source(path)[1] - used if path else set()
    return sorted(used)


@cache
def source_digest(*names: str, registries: frozenset[str] = frozenset()) -> str:
    """Return the digest of these modules and of all that they import: 16 hexadecimal digits."""
    files = {name: module_path(name) for name in modules_used(*names, registries=registries)}
    return digest({name: read_source(path)[0] for name, path in files.items() if path})


def computing_digest(*names: str, registries: frozenset[str] = frozenset()) -> str:
    """Return the digest of what computes a result: these modules, all that they import, and the libraries below."""
    return digest(source_digest(*names, registries=registries), versions())
