"""The derivative of the traction of smooth laws, as a map of coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from contactsim.grid import Array

if TYPE_CHECKING:
    from contactsim.contact.cohesive import CohesiveProblem


@dataclass(frozen=True)
class Tangent:
    """Derivative of the traction by the gap at each point (exerted, read, n), GPa/nm, as a map of coefficients."""

    problem: CohesiveProblem
    values: Array

    def __call__(self, change: Array) -> Array:
        """Return the change of the traction's coefficients for one of the displacement's, both (exerted, m)."""
        field = self.problem.field(change)
        return self.problem.coefficients(contract(self.values, field))


def contract(tangent: Array, field: Array) -> Array:
    """Return derivatives (exerted, read, n) times a change of the gap (read, n), summed over what is read."""
    out = tangent[:, 0] * field[0]
    for row in range(1, len(field)):
        out += tangent[:, row] * field[row]
    return out
