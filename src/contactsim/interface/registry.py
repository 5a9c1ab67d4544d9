"""Classes of effects and pairings by their names in the configuration."""

from __future__ import annotations

from typing import Any

from contactsim.interface.attraction import DugdaleAttraction, ExponentialAttraction
from contactsim.interface.cohesive_zone import CohesiveZone, NormalCohesiveZone, UncoupledCohesiveZone
from contactsim.interface.frictional_repulsion import FrictionalRepulsiveZone, StiffMixedZone
from contactsim.interface.hard_wall import HardWall
from contactsim.interface.lattice import Lattice
from contactsim.interface.pairing import Aligned
from contactsim.interface.repulsion import RepulsiveZone, StiffCohesiveZone

EFFECTS: dict[str, Any] = {
    "hard_wall": HardWall,
    "exponential_attraction": ExponentialAttraction,
    "dugdale_attraction": DugdaleAttraction,
    "cohesive_zone": CohesiveZone,
    "normal_cohesive_zone": NormalCohesiveZone,
    "uncoupled_cohesive_zone": UncoupledCohesiveZone,
    "repulsive_zone": RepulsiveZone,
    "frictional_repulsive_zone": FrictionalRepulsiveZone,
    "stiff_cohesive_zone": StiffCohesiveZone,
    "stiff_mixed_zone": StiffMixedZone,
}
PAIRINGS = {"aligned": Aligned, "lattice": Lattice}
