"""Elastic bodies by their names in the configuration."""

from __future__ import annotations

from contactsim.elasticity.half_space import HalfSpace
from contactsim.elasticity.layer import Layer

ELASTICITIES = {"half_space": HalfSpace, "layer": Layer}
