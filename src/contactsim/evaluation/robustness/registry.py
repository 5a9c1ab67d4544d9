"""All hazards by name.

A hazard is a function of its severity that returns a case: heights and a load, or a scene of cohesive laws and
its path; and, where it is known, the exact answer.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable

from contactsim.evaluation.robustness.adhesive import ADHESIVE
from contactsim.evaluation.robustness.adhesive_surfaces import ADHESIVE_SURFACES
from contactsim.evaluation.robustness.attracting_walls import ATTRACTING_WALLS
from contactsim.evaluation.robustness.cases import Case
from contactsim.evaluation.robustness.lines import LINES
from contactsim.evaluation.robustness.path_cases import PathCase
from contactsim.evaluation.robustness.rough import ROUGH
from contactsim.evaluation.robustness.sliding import SLIDING
from contactsim.evaluation.robustness.surfaces import SURFACES

GROUPS = (LINES, SURFACES, ADHESIVE, ADHESIVE_SURFACES, ATTRACTING_WALLS, ROUGH, SLIDING)
HAZARDS: dict[str, Callable[[float], Case | PathCase]] = {
    hazard.__name__: hazard for group in GROUPS for hazard in group
}


def describe_hazard(hazard: str) -> str:
    """Return the first line of a hazard's docstring, which says what gets harder."""
    return inspect.cleandoc(HAZARDS[hazard].__doc__ or "").partition("\n")[0]
