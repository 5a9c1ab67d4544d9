"""Contact of rough and smooth elastic solids on periodic grids."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # what `PUBLIC` imports at run time, for type checkers and editors
    from contactsim import reference as reference
    from contactsim.characterisation import characterise as characterise
    from contactsim.contact.loading import LoadPath as LoadPath
    from contactsim.contact.loading import approaches as approaches
    from contactsim.contact.loading import pressures as pressures
    from contactsim.contact.loading import sliding as sliding
    from contactsim.contact.scene import RIGID as RIGID
    from contactsim.contact.scene import Body as Body
    from contactsim.contact.scene import Scene as Scene
    from contactsim.dataset import load_dataset as load_dataset
    from contactsim.elasticity.half_space import FreeHalfSpace as FreeHalfSpace
    from contactsim.elasticity.half_space import HalfSpace as HalfSpace
    from contactsim.elasticity.layer import Layer as Layer
    from contactsim.errors import InputError as InputError
    from contactsim.figures.characterisation import plot_characterisation as plot_characterisation
    from contactsim.figures.plot import plot as plot
    from contactsim.interface.attraction import DugdaleAttraction as DugdaleAttraction
    from contactsim.interface.attraction import ExponentialAttraction as ExponentialAttraction
    from contactsim.interface.base import Law as Law
    from contactsim.interface.cohesive_zone import CohesiveZone as CohesiveZone
    from contactsim.interface.cohesive_zone import NormalCohesiveZone as NormalCohesiveZone
    from contactsim.interface.cohesive_zone import UncoupledCohesiveZone as UncoupledCohesiveZone
    from contactsim.interface.frictional_repulsion import FrictionalRepulsiveZone as FrictionalRepulsiveZone
    from contactsim.interface.frictional_repulsion import StiffMixedZone as StiffMixedZone
    from contactsim.interface.hard_wall import HardWall as HardWall
    from contactsim.interface.lattice import Lattice as Lattice
    from contactsim.interface.pairing import Aligned as Aligned
    from contactsim.interface.repulsion import RepulsiveZone as RepulsiveZone
    from contactsim.interface.repulsion import StiffCohesiveZone as StiffCohesiveZone
    from contactsim.observables.conductance import conductance as conductance
    from contactsim.observables.patches import find_patches as find_patches
    from contactsim.paths.adaptive import Adaptive as Adaptive
    from contactsim.paths.contact_stiffness import contact_stiffness as contact_stiffness
    from contactsim.paths.nested import Nested as Nested
    from contactsim.paths.partial_slip import partial_slip as partial_slip
    from contactsim.paths.requested import Requested as Requested
    from contactsim.simulation import estimate_cost as estimate_cost
    from contactsim.simulation import explain as explain
    from contactsim.simulation import neglect as neglect
    from contactsim.simulation import simulate as simulate
    from contactsim.single_load import press as press
    from contactsim.solvers.base import Result as Result
    from contactsim.status import Status as Status
    from contactsim.surfaces.preparation import prepare_topography as prepare_topography
    from contactsim.surfaces.scan_files import read_topography as read_topography
    from contactsim.surfaces.self_affine import SelfAffine as SelfAffine
    from contactsim.surfaces.shapes import Cylinder as Cylinder
    from contactsim.surfaces.shapes import Flat as Flat
    from contactsim.surfaces.shapes import Sinusoid as Sinusoid
    from contactsim.surfaces.shapes import Sphere as Sphere
    from contactsim.surfaces.topography import Topography as Topography

    __version__: str

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
    "Requested": "paths.requested",
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
