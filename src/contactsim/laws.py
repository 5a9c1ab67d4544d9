"""What acts at the interface, one small frozen class each.

Effects add: a scene lists them and the traction is their sum. The hard wall is the limit of infinite stiffness: not a
traction as a function of the gap but an inequality, whose pressure is an unknown.
"""

from __future__ import annotations

from dataclasses import dataclass

from contactsim.traits import Trait


@dataclass(frozen=True)
class HardWall:
    """Impenetrability (Section 2.3): gap ≥ 0, pressure ≥ 0, and one of them zero at each point."""

    reads = frozenset({"n"})
    exerts = frozenset({"n"})
    traits = frozenset({Trait.WALL})


EFFECTS = {"hard_wall": HardWall}
