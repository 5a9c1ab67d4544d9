"""The current or heat that flows through a contact."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from contactsim.arguments import Only, Positive, Values, checked
from contactsim.errors import InputError, is_positive
from contactsim.grid import Array


def _is_pair(value: object) -> bool:
    """Return True for two positive numbers, one of which may be infinite."""
    return isinstance(value, tuple | list) and len(value) == 2 and all(map(_conducts, value)) and min(value) < np.inf


def _conducts(value: object) -> bool:
    """Return True for a positive number or infinity."""
    return is_positive(value) or (isinstance(value, float) and value == np.inf)


Conductivities = Annotated[
    tuple[float, float],
    Annotated[object, Only("a pair of positive numbers, at most one of them infinite", _is_pair)],
]


@checked
def conductance(stiffness: Values, contact_modulus: Positive, conductivities: Conductivities) -> float | Array:
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
    stiffnesses = np.asarray(stiffness, float)
    if (stiffnesses < 0).any():
        raise InputError("stiffness", stiffness, "0 or more")
    values = 2 * stiffnesses / (contact_modulus * (1 / conductivities[0] + 1 / conductivities[1]))
    return values if values.ndim else float(values)
