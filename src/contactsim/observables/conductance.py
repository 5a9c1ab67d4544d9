"""The current or heat that flows through a contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from contactsim.errors import POSITIVE, InputError, is_positive
from contactsim.grid import Array


def conductance(stiffness: ArrayLike, contact_modulus: float, conductivities: tuple[float, float]) -> float | Array:
    """Return the current or heat that flows through a contact for each difference far away, by Barber's relation.

    Stiffness and conductance are alike: both solve the same problem on the points in contact.

    Parameters
    ----------
    stiffness : float or array
        Contact stiffness for each length or area, of one load or of several.
    contact_modulus : float
        E* of the pair.
    conductivities : (float, float)
        Electrical or thermal conductivities of both bodies; infinite for a perfect conductor.

    Returns
    -------
    float or array
        2 stiffness / (E* (1/c₁ + 1/c₂)), for each length or area, in units of conductivity over length: of
        conductivities in W/(m K) and lengths in nm it is in W/(m K nm), 1e9 W/(m² K).

    References
    ----------
    J. R. Barber, Proc. R. Soc. Lond. A 459, 53 (2003).
    """
    if not is_positive(contact_modulus):
        raise InputError("contact_modulus", contact_modulus, POSITIVE)
    pair = tuple(conductivities) if isinstance(conductivities, tuple | list) else ()
    if len(pair) != 2 or not all(is_positive(value) or value == np.inf for value in pair) or min(pair) == np.inf:
        raise InputError("conductivities", conductivities, "a pair of positive numbers, at most one of them infinite")
    stiffnesses = np.asarray(stiffness, float)
    if (stiffnesses < 0).any():
        raise InputError("stiffness", stiffness, "0 or more")
    values = 2 * stiffnesses / (contact_modulus * (1 / pair[0] + 1 / pair[1]))
    return values if values.ndim else float(values)
