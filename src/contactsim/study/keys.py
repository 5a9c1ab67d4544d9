"""The keys of a study: which there are, what each may be, and what a load or a path amounts to.

Sections whose `kind` decides which keys they have are read further by the study; a law's options are a section of the
law's own name.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from contactsim.contact import loading
from contactsim.contact.simplification import SIMPLIFICATIONS
from contactsim.elasticity.solids import ELASTICITIES
from contactsim.errors import SceneError
from contactsim.interface.registry import EFFECTS, PAIRINGS
from contactsim.observables.contact import KEPT
from contactsim.paths.increments import INCREMENTS
from contactsim.solvers.registry import DEFAULT_SOLVERS, SOLVERS, solver_class
from contactsim.study.kinds import STUDY_KINDS, problem_kind, study_kind
from contactsim.study.reading import Key, choice, keys_of, listed, mapping, number, positive, read, text, whole
from contactsim.surfaces.measured import SURFACES
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait
from contactsim.variables import LOADS


def turning(value: object) -> list[float]:
    """Two or more numbers; one that is given twice in a row is a hold."""
    if not isinstance(value, list) or len(value) < 2:
        raise ValueError
    return [number(entry) for entry in value]


def some_of(known: Mapping[str, object]) -> Callable[[object], list[str]]:
    """A check for a list of names, which may be empty."""
    return lambda value: [] if value == [] else listed(choice(known))(value)


def fraction(value: object) -> float:
    """A number above zero and below one."""
    if not 0 < number(value) < 1:
        raise ValueError
    return number(value)


def error_or_more(value: object) -> float | dict:
    """A relative error, or a mapping, read further where its place is known."""
    return value if isinstance(value, dict) else fraction(value)


def effects_or_more(value: object) -> list[str] | dict:
    """A list of effects, or a mapping, read further where its place is known."""
    return value if isinstance(value, dict) else listed(choice(EFFECTS))(value)


AUTO_KEYS = {
    "auto": Key(listed(choice(EFFECTS)), f"a list from {sorted(EFFECTS)}"),
    "within": Key(fraction, "a relative change, above 0 and below 1"),
    "of": Key(listed(text), "a list of quantities"),
    "sample": Key(whole(1), "a whole number of members, 1 or more", 1),
}
ACCURACY_KEYS = {
    "error": Key(fraction, "a relative error, above 0 and below 1"),
    "of": Key(listed(text), "a list of quantities", []),
}


ORIGINS = ("mean_plane", "first_touch")
"""Where approach is zero: see `contactsim.contact.loading`."""
RIGID = "rigid"
"""Kind of a body that does not give way, and has no keys."""


@dataclass(frozen=True)
class Rigid:
    """No elasticity, and nothing to say of it."""


SOLIDS = ELASTICITIES | {RIGID: Rigid}
KINDS: dict[str, tuple[Mapping[str, object], Callable[[str], type]]] = {
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
    "effects": Key(effects_or_more, f"a list from {sorted(EFFECTS)}, or a mapping with `auto`, `within` and `of`"),
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
    "thesis_points": Key(whole(2), "grid points of the thesis, for the footer", None),
    "members": Key(whole(1), "a whole number, 1 or more", 1),
    "coarse_grid": Key(mapping, "a mapping with `points` and `members`", None),
    "tight_tolerance": Key(mapping, "a mapping with `tolerance` and `members`", None),
    "neglect": Key(some_of(SIMPLIFICATIONS), f"a list from {', '.join(SIMPLIFICATIONS)}", []),
    "full_model": Key(mapping, "a mapping with `members`, of runs that neglect nothing", None),
    "solver": Key(mapping, "a mapping with `kind` and that solver's options", {}),
    "tolerance": Key(positive, "a positive number: of grid steps or, of smooth laws, parts of their strength", None),
    "accuracy": Key(error_or_more, "a relative error below 1, or a mapping with `error` and `of`", None),
    "keep": Key(listed(choice(KEPT)), f"a list from {', '.join(KEPT)}", list(KEPT[:-1])),
    "fit_limits": Key(listed(positive), "a list of largest reduced pressures to fit Eq. 3.11 to", None),
}
STUDY_KEYS |= {
    name: Key(mapping, f"a mapping with the keys of the effect {name}", {})
    for name in EFFECTS
    if keys_of(EFFECTS[name])
}
CHOSEN = ("points", "tolerance", "increments", "coarse_grid", "tight_tolerance")
"""What a study leaves out where it asks for an accuracy, beside the increments of its path."""
BEGIN = {"points": 2**14, "tolerance": 1e-3}
"""Of a run whose own are chosen for an accuracy, until they are."""
PATH_KEYS = {
    "approach": Key(turning, "a list of turning points in nm, two or more", None),
    "mean_pressure": Key(turning, "a list of turning points in GPa, two or more", None),
    "increment": Key(positive, "a positive number", None),
    "origin": Key(choice(ORIGINS), f"one of {', '.join(ORIGINS)}", ORIGINS[0]),
}
SLIDE_KEYS = {
    "through": Key(turning, "a list of turning points in nm, two or more; the first is where the slide begins"),
    "increment": Key(positive, "a positive number of nm", None),
    "approach": Key(number, "the approach in nm at which surfaces slide, to which the path goes on, or left out", None),
    "mean_pressure": Key(number, "the mean pressure in GPa under which surfaces slide, or left out", None),
}
FEWER = {"members": Key(whole(1), "a whole number, at most the study's members")}
ERROR_RUNS = {
    "coarse_grid": (
        "points",
        "grid",
        {"points": Key(whole(2), "a whole number of grid points, fewer than the study's")} | FEWER,
    ),
    "tight_tolerance": (
        "tolerance",
        "tolerance",
        {"tolerance": Key(positive, "a positive number, in the units of the study's and below it")} | FEWER,
    ),
    "full_model": ("neglect", "neglect", FEWER),
}
"""Sections that ask for runs that measure an error: the key in which they differ, the kind of error, of
`variables.ERRORS`, and their keys."""


def acting(settings: dict, file: object, prefix: str) -> dict:
    """Effects as a list and, where what is negligible among them is to be left out, to what tolerance."""
    given = settings["effects"]
    if not isinstance(given, dict):
        return {"auto": None}
    auto = read(given, AUTO_KEYS, file, f"{prefix}.effects")
    if settings["neglect"]:
        allowed = "left out, for what is negligible is left out anyway"
        raise SceneError(f"{prefix}.neglect", settings["neglect"], allowed, file)
    effects = auto.pop("auto")
    known = STUDY_KINDS[problem_kind(effects)].comparable
    for name in auto["of"]:
        if name not in known:
            raise SceneError(f"{prefix}.effects.of", name, f"some of {', '.join(known)}", file)
    if auto["sample"] > settings["members"]:
        allowed = f"at most {settings['members']}, the study's members"
        raise SceneError(f"{prefix}.effects.sample", auto["sample"], allowed, file)
    return {"effects": effects, "auto": auto}


FOLLOWS = "left out, for it follows from the accuracy"


def settled(section: dict, settings: dict, file: object, prefix: str) -> dict:
    """Settings with a tolerance and, for an accuracy, a grid to begin with; SceneError where both say something."""
    if settings["accuracy"] is None:
        if settings["tolerance"] is None:
            allowed = f"{STUDY_KEYS['tolerance'].allowed} (the key is missing)"
            raise SceneError(f"{prefix}.tolerance", "nothing", allowed, file)
        return settings
    for key in CHOSEN:
        if section.get(key) is not None:
            raise SceneError(f"{prefix}.{key}", section[key], FOLLOWS, file)
    for key, values in settings["vary"].items():
        if key == "points" or str(key).endswith(".increment") or str(key).startswith("increments."):
            raise SceneError(f"{prefix}.vary.{key}", values, FOLLOWS, file)
    kept = {"snapshots": settings["snapshots"], "keep": "fields" in settings["keep"] and settings["keep"]}
    for key in [key for key, value in kept.items() if value]:
        if settings["vary"] or settings["members"] > 1:
            allowed = "left out, for runs to an accuracy have grids of their own; or one run"
            raise SceneError(f"{prefix}.{key}", kept[key], allowed, file)
    given = settings["accuracy"]
    accuracy = read(given if isinstance(given, dict) else {"error": given}, ACCURACY_KEYS, file, f"{prefix}.accuracy")
    return settings | BEGIN | {"accuracy": accuracy}


def read_load(settings: dict, file: object, prefix: str) -> dict:
    """The loads of a study by name and values; of a path, its steps."""
    given = [name for name in ("load", "path") if settings[name] is not None]
    if len(given) != 1:
        allowed = f"exactly one of load ({', '.join(LOADS)}) and path"
        raise SceneError(f"{prefix}.load", "both load and path" if given else "nothing", allowed, file)
    if given == ["load"]:
        if study_kind(settings).needs_path:
            raise SceneError(f"{prefix}.load", settings["load"], "path: smooth laws depend on what came before", file)
        return _loads(settings["load"], file, f"{prefix}.load")
    return _path(settings["path"], settings["accuracy"] is not None, file, f"{prefix}.path")


def _loads(section: dict, file: object, prefix: str) -> dict:
    values = Key(listed(number), "a list of numbers, none twice", None)
    given = {name: value for name, value in read(section, dict.fromkeys(LOADS, values), file, prefix).items() if value}
    if len(given) != 1:
        raise SceneError(prefix, section, f"exactly one of {', '.join(LOADS)}", file)
    ((name, numbers),) = given.items()
    if min(numbers) <= 0:
        raise SceneError(f"{prefix}.{name}", min(numbers), "numbers above 0", file)
    return {"name": name, "values": sorted(numbers)}


def _paced(section: dict, accurate: bool, file: object, prefix: str) -> dict:
    """A section with increments: its own or, where they follow from an accuracy, some to begin with."""
    if accurate and section["increment"] is not None:
        raise SceneError(f"{prefix}.increment", section["increment"], FOLLOWS, file)
    if not accurate and section["increment"] is None:
        raise SceneError(
            f"{prefix}.increment", "nothing", f"{PATH_KEYS['increment'].allowed} (the key is missing)", file
        )
    return section | {"increment": section["increment"] or 1.0}


def _path(section: dict, accurate: bool, file: object, prefix: str) -> dict:
    section = _paced(read(section, PATH_KEYS, file, prefix), accurate, file, prefix)
    controls = [name for name in ("approach", "mean_pressure") if section[name] is not None]
    if len(controls) != 1:
        raise SceneError(prefix, section, "exactly one of approach and mean_pressure", file)
    points, control = section[controls[0]], Trait[controls[0].upper()]
    try:
        path = loading.sweep(control, points, section["increment"])
    except SceneError as error:
        raise error.within(file, prefix) from error
    given = {"control": controls[0], "through": points, "increment": section["increment"]}
    if section["origin"] != ORIGINS[0]:
        if control is not Trait.APPROACH:
            raise SceneError(f"{prefix}.origin", section["origin"], "left out, for pressure has none", file)
        given["origin"] = section["origin"]
    return {"name": "step"} | given | {"values": [step.value for step in path.steps]}


def read_slide(settings: dict, file: object, prefix: str) -> dict | None:
    """How surfaces slide after the path has pressed them; None where they do not."""
    if settings["slide"] is None:
        return None
    if not study_kind(settings).needs_path or settings["path"] is None:
        raise SceneError(f"{prefix}.slide", settings["slide"], "left out, but for smooth laws and a path", file)
    section = slide_part(settings["slide"], file, f"{prefix}.slide", settings["accuracy"] is not None)
    if "approach" in section and settings["load"]["control"] != "approach":
        raise SceneError(f"{prefix}.slide.approach", section["approach"], "mean_pressure, as the path has", file)
    return section


def slide_part(section: dict, file: object, prefix: str, accurate: bool = False) -> dict:
    """The section of a slide, with the one thing that is held; accurate: whether its increments follow."""
    section = _paced(read(section, SLIDE_KEYS, file, prefix), accurate, file, prefix)
    left_out = [name for name in ("approach", "mean_pressure") if section[name] is None]
    if len(left_out) != 1:
        raise SceneError(prefix, section, "exactly one of approach and mean_pressure", file)
    return {name: value for name, value in section.items() if name not in left_out}


def default_solver(settings: dict) -> str:
    """Return the name of the default solver for a study's surface and effects; what is wrong is refused later."""
    surface = settings["surface"]
    kind = SURFACES.get(str(surface.get("kind")), Flat)
    dimensions = surface.get("dimensions", getattr(kind, "dimensions", 2 if surface.get("width") else 1))
    return DEFAULT_SOLVERS[problem_kind(settings["effects"]), dimensions]
