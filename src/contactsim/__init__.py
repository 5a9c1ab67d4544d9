"""Contact of rough and smooth elastic solids on periodic grids."""

from __future__ import annotations

from importlib import import_module

PUBLIC = {
    "SceneError": "errors",
    "press": "simulation",
    "simulate": "simulation",
}
"""Module of each public name; imported when first used."""

__all__ = [*PUBLIC, "__version__"]


def __getattr__(name: str) -> object:
    """Import a public name on first use."""
    if name == "__version__":
        from importlib.metadata import version

        return version("contactsim")
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"contactsim.{PUBLIC[name]}"), name)


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
