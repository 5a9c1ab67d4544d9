"""Contact of rough and smooth elastic solids on periodic grids."""

from __future__ import annotations

from importlib import import_module

PUBLIC = {
    "press": "single_load",
    "characterise": "characterisation",
    "contact_stiffness": "paths.contact_stiffness",
    "conductance": "observables.conductance",
    "partial_slip": "paths.partial_slip",
    "find_patches": "observables.patches",
    "simulate": "simulation",
    "estimate_cost": "simulation",
    "neglect": "simulation",
    "explain": "simulation",
    "Scene": "contact.scene",
    "Body": "contact.scene",
    "RIGID": "contact.scene",
    "LoadPath": "contact.loading",
    "pressures": "contact.loading",
    "approaches": "contact.loading",
    "sliding": "contact.loading",
    "HalfSpace": "elasticity.half_space",
    "FreeHalfSpace": "elasticity.half_space",
    "Layer": "elasticity.layer",
    "Flat": "surfaces.shapes",
    "Cylinder": "surfaces.shapes",
    "Sphere": "surfaces.shapes",
    "Sinusoid": "surfaces.shapes",
    "SelfAffine": "surfaces.self_affine",
    "Topography": "surfaces.topography",
    "read_topography": "surfaces.scan_files",
    "prepare_topography": "surfaces.preparation",
    "HardWall": "interface.hard_wall",
    "ExponentialAttraction": "interface.attraction",
    "DugdaleAttraction": "interface.attraction",
    "CohesiveZone": "interface.cohesive_zone",
    "NormalCohesiveZone": "interface.cohesive_zone",
    "UncoupledCohesiveZone": "interface.cohesive_zone",
    "RepulsiveZone": "interface.repulsion",
    "StiffCohesiveZone": "interface.repulsion",
    "FrictionalRepulsiveZone": "interface.frictional_repulsion",
    "StiffMixedZone": "interface.frictional_repulsion",
    "Law": "interface.base",
    "Aligned": "interface.pairing",
    "Lattice": "interface.lattice",
    "Requested": "paths.increments",
    "Adaptive": "paths.adaptive",
    "Nested": "paths.nested",
    "Result": "solvers.base",
    "Status": "status",
    "InputError": "errors",
    "load_dataset": "dataset",
    "plot": "figures.plot",
    "plot_characterisation": "figures.characterisation",
}
"""Module of each public name; it is imported when the name is first used."""
MODULES = ("reference",)
"""Public modules."""

__all__ = [*PUBLIC, "__version__"]


def __getattr__(name: str) -> object:
    """Import a public name on first use."""
    if name == "__version__":
        from importlib.metadata import version

        return version("contactsim")
    if name in MODULES:
        return import_module(f"contactsim.{name}")
    if name not in PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"contactsim.{PUBLIC[name]}"), name)


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
