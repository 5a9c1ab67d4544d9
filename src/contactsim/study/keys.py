"""Tables of the keys of a study: which there are, and what each may be.

Sections whose `kind` decides which keys they have are read further by the study; a law's options are a section of the
law's own name. `contactsim.study.sections` reads what depends on several keys.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.elasticity.registry import ELASTICITIES
from contactsim.interface.registry import EFFECTS, PAIRINGS
from contactsim.observables.contact import DEFAULT_KEPT, KEPT
from contactsim.paths.increments import INCREMENTS
from contactsim.paths.options import ENDS
from contactsim.solvers.registry import SOLVERS, solver_class
from contactsim.study.reading import Key, choice, keys_of, listed, mapping, number, positive, text, whole
from contactsim.surfaces.registry import SURFACES
from contactsim.variables import LOADS


def read_turning_points(value: object) -> list[float]:
    """Return two or more numbers; one that is given twice in a row is a hold."""
    if not isinstance(value, list) or len(value) < 2:
        raise ValueError
    return [number(entry) for entry in value]


def any_of(options: Mapping[str, object]) -> Callable[[object], list[str]]:
    """Return a check for a list of names, which may be empty."""
    return lambda value: [] if value == [] else listed(choice(options))(value)


def read_fraction(value: object) -> float:
    """Return a number above zero and below one."""
    if not 0 < number(value) < 1:
        raise ValueError
    return number(value)


def error_or_mapping(value: object) -> float | dict:
    """Return a relative error, or a mapping that is read further where its place is known."""
    return value if isinstance(value, dict) else read_fraction(value)


def effects_or_mapping(value: object) -> list[str] | dict:
    """Return a list of effects, or a mapping that is read further where its place is known."""
    return value if isinstance(value, dict) else listed(choice(EFFECTS))(value)


NEGLECT_KEYS = {
    "list": Key(listed(choice(EFFECTS)), f"a list from {sorted(EFFECTS)}"),
    "neglect_within": Key(read_fraction, "a relative change, above 0 and below 1"),
    "quantities": Key(listed(text), "a list of quantities"),
    "sample": Key(whole(1), "a whole number of members, 1 or more", 1),
}
ACCURACY_KEYS = {
    "error": Key(read_fraction, "a relative error, above 0 and below 1"),
    "quantities": Key(listed(text), "a list of quantities", []),
}


ORIGINS = ("mean_plane", "first_touch")
"""Positions in which the approach is zero: see `contactsim.contact.loading`."""
RIGID = "rigid"
"""Kind of a body that does not deform."""


@dataclass(frozen=True)
class Rigid:
    """No elasticity: a rigid body has no keys."""


SOLIDS = ELASTICITIES | {RIGID: Rigid}
SECTION_KINDS: dict[str, tuple[Mapping[str, object], Callable[[str], type]]] = {
    "surface": (SURFACES, SURFACES.__getitem__),
    "body": (SOLIDS, SOLIDS.__getitem__),
    "counter_body": (ELASTICITIES, ELASTICITIES.__getitem__),
    "pairing": (PAIRINGS, PAIRINGS.__getitem__),
    "solver": (SOLVERS, solver_class),
    "increments": (INCREMENTS, INCREMENTS.__getitem__),
}
"""Sections whose `kind` decides which keys they have: the kinds there are, and the class of each."""
BODIES = ("body", "counter_body")
MODULI = {
    "contact_modulus": Key(number, "a number in GPa, or leave the key out", None),
    "youngs_modulus": Key(number, "a number in GPa, or leave the key out", None),
}
"""Keys of an elastic body, one of which it needs."""

STUDY_KEYS = {
    "title": Key(text, "a line of text"),
    "surface": Key(mapping, "a mapping with `kind` and that kind's keys"),
    "body": Key(mapping, "a mapping with `kind` and that kind's keys"),
    "effects": Key(
        effects_or_mapping,
        f"a list from {sorted(EFFECTS)}, or a mapping with `list`, `neglect_within` and `quantities`",
    ),
    "load": Key(mapping, f"a mapping with one of {', '.join(LOADS)} and its list of values", None),
    "path": Key(
        mapping, "a mapping with one of approach and mean_pressure, a list of turning points, and increment", None
    ),
    "counter_body": Key(mapping, "a mapping as `body`, of the body above; rigid without it", None),
    "pairing": Key(mapping, "a mapping with `kind` and that kind's keys; aligned without it", None),
    "slide": Key(mapping, "a mapping with through, increment, and one of approach and mean_pressure", None),
    "increments": Key(mapping, "a mapping with `kind` and that kind's keys", {"kind": "requested"}),
    "snapshots": Key(
        listed(number), "a list of approaches, pressures or slides at which histograms and fields are kept", None
    ),
    "snapshot_members": Key(whole(1), "of how many members fields are kept, 1 or more; left out, of all", None),
    "vary": Key(mapping, "a mapping from keys of this study to lists of values", {}),
    "points": Key(whole(2), "a whole number of grid points, 2 or more; left out for a measured surface", None),
    "same_surfaces_as": Key(text, "the name of a study of this chapter with the same random surfaces", None),
    "thesis_points": Key(whole(2), "grid points of the thesis", None),
    "members": Key(whole(1), "a whole number, 1 or more", 1),
    "coarse_grid": Key(mapping, "a mapping with `points` and `members`", None),
    "tight_tolerance": Key(mapping, "a mapping with `tolerance` and `members`", None),
    "neglect": Key(any_of(SIMPLIFICATIONS), f"a list from {', '.join(SIMPLIFICATIONS)}", []),
    "full_model": Key(mapping, "a mapping with `members`, of runs that neglect nothing", None),
    "solver": Key(mapping, "a mapping with `kind` and that solver's options", {}),
    "tolerance": Key(positive, "a positive number: of grid steps or, of smooth laws, parts of their strength", None),
    "accuracy": Key(error_or_mapping, "a relative error below 1, or a mapping with `error` and `quantities`", None),
    "keep": Key(listed(choice(KEPT)), f"a list from {', '.join(KEPT)}", list(DEFAULT_KEPT)),
    "fit_limits": Key(listed(positive), "a list of largest reduced pressures to fit Eq. 3.11 to", None),
}
STUDY_KEYS |= {
    name: Key(mapping, f"a mapping with the keys of the effect {name}", {})
    for name in EFFECTS
    if keys_of(EFFECTS[name])
}
FROM_ACCURACY = ("points", "tolerance", "increments", "coarse_grid", "tight_tolerance")
"""Keys that follow from an accuracy, as do the increments of a path."""
INITIAL_OPTIONS = {"points": 2**14, "tolerance": 1e-3}
"""Grid and tolerance of a run until its own are chosen for an accuracy."""
PATH_KEYS = {
    "approach": Key(read_turning_points, "a list of turning points in nm, two or more", None),
    "mean_pressure": Key(read_turning_points, "a list of turning points in GPa, two or more", None),
    "increment": Key(positive, "a positive number", None),
    "origin": Key(choice(ORIGINS), f"one of {', '.join(ORIGINS)}", ORIGINS[0]),
    "until": Key(choice(ENDS), f"one of {', '.join(ENDS)}, or left out for the whole path", None),
}
SLIDE_KEYS = {
    "through": Key(read_turning_points, "turning points in nm, two or more; the slide begins at the first"),
    "increment": Key(positive, "a positive number of nm", None),
    "approach": Key(number, "the approach in nm at which surfaces slide, to which the path goes on, or left out", None),
    "mean_pressure": Key(number, "the mean pressure in GPa under which surfaces slide, or left out", None),
}
MEMBER_KEYS = {"members": Key(whole(1), "a whole number, at most the study's members")}
ERROR_RUNS = {
    "coarse_grid": (
        "points",
        "grid",
        {"points": Key(whole(2), "a whole number of grid points, fewer than the study's")} | MEMBER_KEYS,
    ),
    "tight_tolerance": (
        "tolerance",
        "tolerance",
        {"tolerance": Key(positive, "a positive number, in the units of the study's and below it")} | MEMBER_KEYS,
    ),
    "full_model": ("neglect", "neglect", MEMBER_KEYS),
}
"""Sections that ask for runs that measure an error: the key in which these differ from the study's own runs, the kind
of error, of `variables.ERRORS`, and the section's keys."""
