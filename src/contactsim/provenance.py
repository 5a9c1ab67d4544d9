"""Which code made a result.

The workflow gives each job a digest of the modules that it executes, found by following their import statements. An
edit of a module then reruns exactly the jobs that used it, and a stored point is reused only by the code that made it.
"""

from __future__ import annotations

import ast
import hashlib
import json
from functools import cache
from importlib import metadata
from pathlib import Path

PACKAGE = "contactsim"
LIBRARIES = ("numpy", "scipy", "ducc0", "numba", "xarray", "netCDF4")


@cache
def package_root() -> Path:
    """Folder that holds the package's modules."""
    return Path(__file__).parent


def module_path(name: str) -> Path | None:
    """File of a module of this package, None for anything else."""
    head, *parts = name.split(".")
    if head != PACKAGE:
        return None
    base = package_root().joinpath(*parts)
    file = base / "__init__.py" if base.is_dir() else base.with_suffix(".py")
    return file if file.exists() else None


@cache
def imports_of(name: str) -> frozenset[str]:
    """Modules of this package that a module imports, anywhere in it."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(module_path(name).read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.add(node.module)
            found.update(f"{node.module}.{alias.name}" for alias in node.names)
    return frozenset(module for module in found if module_path(module) is not None)


def modules_used(*names: str) -> tuple[str, ...]:
    """These modules and all that they import, directly or not, sorted; the bare package is not one."""
    known: set[str] = set()
    waiting = list(names)
    while waiting:
        module = waiting.pop()
        if module not in known and module != PACKAGE:
            known.add(module)
            waiting.extend(imports_of(module))
    return tuple(sorted(known))


@cache
def source_digest(*names: str) -> str:
    """Digest of the text of these modules and of all that they import: 16 hexadecimal digits."""
    text = hashlib.sha256()
    for module in modules_used(*names):
        text.update(module.encode() + b"\0" + module_path(module).read_bytes() + b"\0")
    return text.hexdigest()[:16]


def computing_digest(*names: str) -> str:
    """Digest of what computes a result: these modules, all that they import, and the libraries that it depends on."""
    return digest(source_digest(*names), versions())


def canonical(settings: object) -> str:
    """JSON with sorted keys and no spaces: the same text for the same settings, whatever their order."""
    return json.dumps(settings, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def digest(*parts: object) -> str:
    """16 hexadecimal digits for any settings."""
    return hashlib.sha256(canonical(parts).encode()).hexdigest()[:16]


@cache
def versions() -> dict[str, str]:
    """Version of this package and of the libraries that results depend on."""
    return {name: metadata.version(name) for name in (PACKAGE, *LIBRARIES)}
