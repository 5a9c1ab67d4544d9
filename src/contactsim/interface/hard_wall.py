"""The hard wall: the limit of infinite stiffness.

It is no law. The traction is not a function of the gap but an unknown, bound by an inequality.
"""

from __future__ import annotations

from dataclasses import dataclass

from contactsim.traits import Trait


@dataclass(frozen=True)
class HardWall:
    """Impenetrability (Section 2.3): gap ≥ 0, pressure ≥ 0, and one of them is zero at each point."""

    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.WALL})
