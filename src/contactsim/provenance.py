"""Digests of settings, and the versions of the libraries that results depend on."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from importlib import metadata

PACKAGE = "contactsim"
LIBRARIES = ("numpy", "scipy", "ducc0", "numba", "xarray", "netCDF4")


def canonical(settings: object) -> str:
    """Return settings as JSON with sorted keys and no spaces: one text, whatever the order of the keys."""
    return json.dumps(settings, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def digest(*parts: object) -> str:
    """Return the digest of any settings: 16 hexadecimal digits."""
    return hashlib.sha256(canonical(parts).encode()).hexdigest()[:16]


@cache
def versions() -> dict[str, str]:
    """Return the versions of this package and of the libraries that results depend on."""
    return {name: metadata.version(name) for name in (PACKAGE, *LIBRARIES)}
