"""Elastic bodies by their names in the configuration."""

from __future__ import annotations

from contactsim.elasticity.base import Elasticity
from contactsim.elasticity.half_space import FreeHalfSpace, HalfSpace
from contactsim.elasticity.layer import Layer
from contactsim.errors import NOTHING, POSITIVE, InputError, Words, is_positive

ELASTICITIES = {"half_space": HalfSpace, "free_half_space": FreeHalfSpace, "layer": Layer}


def make_elasticity(
    kind: str,
    *,
    contact_modulus: float | None = None,
    youngs_modulus: float | None = None,
    poisson_ratio: float | None = None,
    **options: float,
) -> Elasticity:
    """Return an elastic body by its contact modulus or by Young's modulus.

    Parameters
    ----------
    kind : str
        Name of the kind, of `ELASTICITIES`.
    contact_modulus, youngs_modulus : float
        E* or E = (1 - ν²) E* (GPa); exactly one, the second with Poisson's ratio ν.
    poisson_ratio : float, optional
        Poisson's ratio.
    **options : float
        Further parameters of the kind, such as `thickness` (nm).

    Raises
    ------
    InputError
        For both or none of the moduli, or one that is not positive.
    """
    if (youngs_modulus is None) == (contact_modulus is None):
        moduli = NOTHING if contact_modulus is None else Words("both")
        raise InputError("contact_modulus", moduli, "exactly one of contact_modulus and youngs_modulus")
    if youngs_modulus is not None:
        if poisson_ratio is None:
            raise InputError("poisson_ratio", None, "a number, where Young's modulus is given")
        if not is_positive(youngs_modulus):
            raise InputError("youngs_modulus", youngs_modulus, f"{POSITIVE}, in GPa")
        contact_modulus = youngs_modulus / (1 - poisson_ratio**2)
    return ELASTICITIES[kind](contact_modulus=contact_modulus, poisson_ratio=poisson_ratio, **options)
