"""The hard wall: the limit of infinite stiffness.

It is no law. The traction is not a function of the gap but an unknown, bound by an inequality.
"""

from __future__ import annotations

from dataclasses import dataclass

from contactsim.arguments import Modulus, checked
from contactsim.traits import Trait


@checked
@dataclass(frozen=True)
class HardWall:
    """Impenetrability (Section 2.3): gap ≥ 0, pressure ≥ 0, and one of them is zero at each point.

    Parameters
    ----------
    hardness : float, optional
        Pressure above which the softer body yields, GPa. Bodies stay elastic; a run tells the share of the contact
        that would yield.

    Raises
    ------
    InputError
        For a hardness that is not positive.
    """

    hardness: Modulus | None = None
    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.WALL})
