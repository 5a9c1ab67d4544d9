"""Studies of paths through rough contacts: which of their numbers a study has, from its settings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from contactsim.observables.contact_readings import RoughPath
from contactsim.reference.hard_wall import uniaxial_modulus


def rough_path_of(settings: Mapping[str, Any], slips: bool) -> RoughPath | None:
    """Return what decides the numbers of a study's paths; None unless it follows paths through contacts of rough lines.

    Parameters
    ----------
    settings
        Settings of the study.
    slips
        True where one of its laws reads the tangential gap.
    """
    surface = settings["surface"]
    if surface["kind"] != "self_affine" or surface.get("dimensions", 1) != 1 or settings["path"] is None:
        return None
    body, varies_body = settings["body"], any(key.startswith("body.") for key in settings["vary"] or {})
    modulus = None
    if body["kind"] == "half_space" and "youngs_modulus" in body and not varies_body:
        modulus = uniaxial_modulus(body["youngs_modulus"], body["poisson_ratio"])
    return RoughPath(settings["effects"] != ["hard_wall"], slips, modulus)
