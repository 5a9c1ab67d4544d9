"""Read the sections of a study that depend on several keys: effects, accuracy, loads, path and slide."""

from __future__ import annotations

from contactsim.contact.loading import sweep
from contactsim.errors import NOTHING, InputError, Words
from contactsim.interface.registry import EFFECTS
from contactsim.solvers.registry import DEFAULT_SOLVERS
from contactsim.study.keys import (
    ACCURACY_KEYS,
    ERROR_RUNS,
    FROM_ACCURACY,
    INITIAL_OPTIONS,
    NEGLECT_KEYS,
    ORIGINS,
    PATH_KEYS,
    SLIDE_KEYS,
    STUDY_KEYS,
)
from contactsim.study.kind_quantities import KIND_QUANTITIES
from contactsim.study.kinds import STUDY_KINDS, problem_kind, study_kind
from contactsim.study.reading import Key, keys_of, listed, number, read
from contactsim.surfaces.registry import SURFACES
from contactsim.surfaces.shapes import Flat
from contactsim.traits import Trait
from contactsim.variables import LOADS

FOLLOWS = "left out, for it follows from the accuracy"
INITIAL_INCREMENT = 1.0
"""Increment of a path until its own is chosen for an accuracy."""


def read_effects(settings: dict, file: object, prefix: str) -> dict:
    """Return the effects as a list and, where negligible ones are to be neglected, to what tolerance."""
    section = settings["effects"]
    if not isinstance(section, dict):
        return {"auto": None}
    auto = read(section, NEGLECT_KEYS, file, f"{prefix}.effects")
    if settings["neglect"]:
        allowed = "left out, for what is negligible is neglected anyway"
        raise InputError(f"{prefix}.neglect", settings["neglect"], allowed, file)
    effects = auto.pop("list")
    comparable = KIND_QUANTITIES[problem_kind(effects)].comparable
    for name in auto["quantities"]:
        if name not in comparable:
            raise InputError(f"{prefix}.effects.quantities", name, f"some of {', '.join(comparable)}", file)
    if auto["sample"] > settings["members"]:
        allowed = f"at most {settings['members']}, the study's members"
        raise InputError(f"{prefix}.effects.sample", auto["sample"], allowed, file)
    return {"effects": effects, "auto": auto}


def read_accuracy(section: dict, settings: dict, file: object, prefix: str) -> dict:
    """Return the settings with a tolerance or, for an accuracy, with a grid to begin with.

    Raises
    ------
    InputError
        Where neither is given, or a key that follows from the accuracy is given too.
    """
    if settings["accuracy"] is None:
        if settings["tolerance"] is None:
            allowed = f"{STUDY_KEYS['tolerance'].allowed} (the key is missing)"
            raise InputError(f"{prefix}.tolerance", NOTHING, allowed, file)
        return settings
    for key in FROM_ACCURACY:
        if section.get(key) is not None:
            raise InputError(f"{prefix}.{key}", section[key], FOLLOWS, file)
    for key, values in settings["vary"].items():
        if key == "points" or str(key).endswith(".increment") or str(key).startswith("increments."):
            raise InputError(f"{prefix}.vary.{key}", values, FOLLOWS, file)
    fields = {"snapshots": settings["snapshots"], "keep": "fields" in settings["keep"] and settings["keep"]}
    for key in [key for key, value in fields.items() if value]:
        if settings["vary"] or settings["members"] > 1:
            allowed = "left out, for runs to an accuracy have grids of their own; or one run"
            raise InputError(f"{prefix}.{key}", fields[key], allowed, file)
    wanted = settings["accuracy"] if isinstance(settings["accuracy"], dict) else {"error": settings["accuracy"]}
    initial = INITIAL_OPTIONS | ({"points": None} if "file" in settings["surface"] else {})  # it has its own points
    return settings | initial | {"accuracy": read(wanted, ACCURACY_KEYS, file, f"{prefix}.accuracy")}


def read_load(settings: dict, file: object, prefix: str) -> dict:
    """Return the loads of a study by name and values; of a path, its steps."""
    sections = [name for name in ("load", "path") if settings[name] is not None]
    if len(sections) != 1:
        allowed = f"exactly one of load ({', '.join(LOADS)}) and path"
        raise InputError(f"{prefix}.load", Words("both load and path") if sections else NOTHING, allowed, file)
    if sections == ["load"]:
        if study_kind(settings).needs_path:
            allowed = "path: a state of cohesive laws depends on those before"
            raise InputError(f"{prefix}.load", settings["load"], allowed, file)
        return _read_loads(settings["load"], file, f"{prefix}.load")
    if "until" in settings["path"] and not study_kind(settings).needs_path:
        raise InputError(f"{prefix}.path.until", settings["path"]["until"], "left out, but for cohesive laws", file)
    return _read_path(settings["path"], settings["accuracy"] is not None, file, f"{prefix}.path")


def _read_loads(section: dict, file: object, prefix: str) -> dict:
    """Return single loads, sorted, with their name."""
    values = Key(listed(number), "a list of numbers, none twice", None)
    lists = {name: value for name, value in read(section, dict.fromkeys(LOADS, values), file, prefix).items() if value}
    if len(lists) != 1:
        raise InputError(prefix, section, f"exactly one of {', '.join(LOADS)}", file)
    ((name, numbers),) = lists.items()
    if min(numbers) <= 0:
        raise InputError(f"{prefix}.{name}", min(numbers), "numbers above 0", file)
    return {"name": name, "values": sorted(numbers)}


def _read_increment(section: dict, accurate: bool, file: object, prefix: str) -> dict:
    """Return a section with its increment; where that follows from an accuracy, with one to begin with."""
    if accurate and section["increment"] is not None:
        raise InputError(f"{prefix}.increment", section["increment"], FOLLOWS, file)
    if not accurate and section["increment"] is None:
        allowed = f"{PATH_KEYS['increment'].allowed} (the key is missing)"
        raise InputError(f"{prefix}.increment", NOTHING, allowed, file)
    return section | {"increment": section["increment"] or INITIAL_INCREMENT}


def _read_path(section: dict, accurate: bool, file: object, prefix: str) -> dict:
    """Return a path with its control, turning points, increment and steps."""
    section = _read_increment(read(section, PATH_KEYS, file, prefix), accurate, file, prefix)
    controls = [name for name in ("approach", "mean_pressure") if section[name] is not None]
    if len(controls) != 1:
        raise InputError(prefix, section, "exactly one of approach and mean_pressure", file)
    points, control = section[controls[0]], Trait[controls[0].upper()]
    try:
        steps = sweep(control, points, section["increment"]).steps
    except InputError as error:
        raise error.located(file, prefix) from error
    path = {"control": controls[0], "through": points, "increment": section["increment"]}
    if section["origin"] != ORIGINS[0]:
        if control is not Trait.APPROACH:
            raise InputError(f"{prefix}.origin", section["origin"], "left out, for pressure has none", file)
        path["origin"] = section["origin"]
    if section["until"] is not None:
        path["until"] = section["until"]
    return {"name": "step"} | path | {"values": [step.value for step in steps]}


def read_slide(settings: dict, file: object, prefix: str) -> dict | None:
    """Return how surfaces slide after the path has pressed them; None where they do not."""
    if settings["slide"] is None:
        return None
    if not study_kind(settings).needs_path or settings["path"] is None:
        raise InputError(f"{prefix}.slide", settings["slide"], "left out, but for cohesive laws and a path", file)
    section = read_slide_section(settings["slide"], file, f"{prefix}.slide", settings["accuracy"] is not None)
    if "approach" in section and settings["load"]["control"] != "approach":
        raise InputError(f"{prefix}.slide.approach", section["approach"], "mean_pressure, as the path has", file)
    return section


def read_slide_section(section: dict, file: object, prefix: str, accurate: bool = False) -> dict:
    """Return the section of a slide with the one value that is held; accurate: True where its increments follow."""
    section = _read_increment(read(section, SLIDE_KEYS, file, prefix), accurate, file, prefix)
    missing = [name for name in ("approach", "mean_pressure") if section[name] is None]
    if len(missing) != 1:
        raise InputError(prefix, section, "exactly one of approach and mean_pressure", file)
    return {name: value for name, value in section.items() if name not in missing}


def read_error_run(part: str, settings: dict, file: object, prefix: str) -> dict:
    """Return the section of runs that measure an error."""
    knob, _, keys = ERROR_RUNS[part]
    section = read(settings[part], keys, file, f"{prefix}.{part}")
    if knob in settings["vary"]:
        raise InputError(f"{prefix}.{part}", settings[part], f"left out, for {knob} are varied", file)
    if section["members"] > settings["members"]:
        allowed = f"at most {settings['members']}, the study's members"
        raise InputError(f"{prefix}.{part}.members", section["members"], allowed, file)
    if knob not in keys and not (settings[knob] or settings["auto"]):
        raise InputError(f"{prefix}.{part}", section, f"none, for the study has no {knob}", file)
    if knob in keys and (settings[knob] is None or section[knob] >= settings[knob]):
        allowed = f"below the study's {knob}, {settings[knob]}"
        raise InputError(f"{prefix}.{part}.{knob}", section[knob], allowed, file)
    return section


def default_solver_kind(settings: dict) -> str:
    """Return the name of the default solver for a study's surface and effects; what is wrong is refused later."""
    surface = settings["surface"]
    kind = SURFACES.get(str(surface.get("kind")), Flat)
    dimensions = surface.get("dimensions", getattr(kind, "dimensions", 2 if surface.get("width") else 1))
    return DEFAULT_SOLVERS[problem_kind(settings["effects"]), dimensions]


def refuse_unused(section: dict, settings: dict, file: object, prefix: str) -> None:
    """Raise InputError for the section of an effect that the study lacks, or a key of the other kind of problem."""
    others = [name for name in sorted(set(settings) & set(EFFECTS) - set(settings["effects"])) if settings[name]]
    own = study_kind(settings)
    unused = [key for kind in STUDY_KINDS.values() if kind is not own for key in kind.keys]
    for key in [*others, *(key for key in unused if section.get(key) is not None)]:
        what = "section" if key in EFFECTS else "key"
        allowed = f"no such {what}, as effects are {', '.join(settings['effects'])}"
        raise InputError(f"{prefix}.{key}", settings[key], allowed, file)


def effect_sections(settings: dict) -> list[str]:
    """Return the names of the effects on whose keys runs depend: those that are given, required or have a default."""
    return [
        name
        for name in settings["effects"]
        if settings.get(name) or any(key.default is not None for key in keys_of(EFFECTS[name]).values())
    ]
