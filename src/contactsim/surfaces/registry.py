"""Classes of surfaces by their names in the configuration."""

from __future__ import annotations

from typing import Any

from contactsim.surfaces.measured import MeasuredLine, MeasuredSurface
from contactsim.surfaces.self_affine import SelfAffine
from contactsim.surfaces.shapes import Cylinder, Flat, Sinusoid, Sphere

SURFACES: dict[str, Any] = {
    "flat": Flat,
    "cylinder": Cylinder,
    "sphere": Sphere,
    "sinusoid": Sinusoid,
    "self_affine": SelfAffine,
    "measured": MeasuredLine,
    "measured_surface": MeasuredSurface,
}
