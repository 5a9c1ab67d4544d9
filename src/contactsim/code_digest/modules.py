"""Digests of the modules that compute a result.

The workflow gives each job a digest of the modules that it executes, found by following their imports. An edit that may
change a result then reruns exactly the jobs that used the module, and a stored load step is reused only by the code
that made it.
"""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from contactsim.code_digest.normal_form import SourceCode, read_source
from contactsim.errors import InputError
from contactsim.provenance import PACKAGE, canonical, digest, versions


@cache
def package_root() -> Path:
    """Return the folder that holds the package's modules."""
    return Path(__file__).parent.parent


def module_path(name: str) -> Path | None:
    """Return the file of a module of this package, None for anything else."""
    head, *parts = name.split(".")
    if head != PACKAGE:
        return None
    base = package_root().joinpath(*parts)
    file = base / "__init__.py" if base.is_dir() else base.with_suffix(".py")
    return file if file.exists() else None


@cache
def source_of(name: str) -> SourceCode:
    """Return the source of a module of this package in its normal form."""
    path = module_path(name)
    if path is None:
        raise InputError("module", name, f"a module of {PACKAGE}")
    return read_source(path.read_text(encoding="utf-8"))


@cache
def imports_of(name: str) -> frozenset[str]:
    """Return the modules of this package that a module imports, anywhere in it and for whatever purpose."""
    return frozenset(module for module in source_of(name).imports if module_path(module) is not None)


@cache
def executed_imports(name: str) -> frozenset[str]:
    """Return the modules of this package that the code of a module uses, and the packages that hold them.

    Imports for annotations of functions alone are not among them. A name that a module only passes on counts as
    imported from where it comes.
    """
    modules: set[str] = set()
    waiting = set(source_of(name).used_imports)
    seen: set[str] = set()
    while waiting:
        target = waiting.pop()
        parent, _, member = target.rpartition(".")
        if target in seen:
            continue
        seen.add(target)
        if module_path(target) is not None:
            modules.add(target)
            waiting.add(parent)
        elif module_path(parent) is not None:
            waiting |= source_of(parent).import_targets.get(member, set())
    return frozenset(modules - {PACKAGE})


def modules_used(*names: str, registries: frozenset[str] = frozenset()) -> tuple[str, ...]:
    """Return these modules and all that they use, directly or not, sorted; the bare package is not one.

    What registries import is left out: of the classes that they name, those in use are among `names`.
    """
    used: set[str] = set()
    waiting = list(names)
    while waiting:
        module = waiting.pop()
        if module not in used and module != PACKAGE:
            used.add(module)
            waiting.extend(() if module in registries else executed_imports(module))
    return tuple(sorted(used))


@cache
def source_digest(*names: str, registries: frozenset[str] = frozenset()) -> str:
    """Return the digest of what these modules compute and of all that they use (`modules_used`): 16 hexadecimal digits.

    An edit that cannot change a result changes no digest (`contactsim.code_digest.normal_form`). Docstrings count where
    a module reads them: its own, and those of the modules that it imports.
    """
    text = hashlib.sha256()
    for module in modules_used(*names, registries=registries):
        source = source_of(module)
        if source.normal_form:
            text.update(f"{module}\0{source.normal_form}\0".encode())
        if source.reads_docstrings:
            read = (source_of(other).docstrings for other in sorted({module} | executed_imports(module)))
            text.update(canonical([list(docstrings) for docstrings in read]).encode())
    return text.hexdigest()[:16]


def computing_digest(*names: str, registries: frozenset[str] = frozenset()) -> str:
    """Return the digest of what computes a result: these modules, all that they use, and the libraries below them."""
    return digest(source_digest(*names, registries=registries), versions())
