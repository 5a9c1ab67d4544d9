"""Cases that get harder: from severity 0 to 100, and what is right at each.

A hazard is a function of its severity that returns a case: heights and a load, or a scene of smooth laws and a path
through it; and, where it is known, the right answer.
"""

from __future__ import annotations

from collections.abc import Callable

from contactsim.hazards.adhesive import ADHESIVE
from contactsim.hazards.cases import Case
from contactsim.hazards.lines import LINES
from contactsim.hazards.paths import PathCase
from contactsim.hazards.rough import ROUGH
from contactsim.hazards.sliding import SLIDING
from contactsim.hazards.surfaces import SURFACES

HAZARDS: dict[str, Callable[[float], Case | PathCase]] = {
    hazard.__name__: hazard for hazard in (*LINES, *SURFACES, *ADHESIVE, *ROUGH, *SLIDING)
}


def first_line(hazard: str) -> str:
    """What gets harder, in a sentence: the first line of the hazard's docstring."""
    return HAZARDS[hazard].__doc__.splitlines()[0]
