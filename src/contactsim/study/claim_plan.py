"""Claims as the config gives them: a quantity, its reduction to one number, and the band that the thesis states."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass

from contactsim.analysis.causes import KINDS, Cause
from contactsim.analysis.comparison import SECOND_STUDY
from contactsim.analysis.formulas import FORMULAS
from contactsim.analysis.reductions import ORDERS, REDUCTIONS, reduction_inputs
from contactsim.errors import InputError
from contactsim.study.quantity_names import quantities
from contactsim.study.reading import Key, choice, mapping, number, positive, read, text
from contactsim.study.study import Study


def interval(value: object) -> list[float]:
    """Return two numbers, the smaller one first; ValueError for anything else."""
    if not isinstance(value, list) or len(value) != 2 or number(value[0]) > number(value[1]):
        raise ValueError
    return [number(entry) for entry in value]


def read_selection(section: Mapping, dims: Iterable[str], file: object, prefix: str) -> dict[str, list[float]]:
    """Return the smallest and largest value of each dimension that the section selects.

    Raises
    ------
    InputError
        If a key is not one of `dims` or a value is not an interval.
    """
    keys = dict.fromkeys(dims, Key(interval, "least and largest value", None))
    return {dim: ends for dim, ends in read(section, keys, file, prefix).items() if ends is not None}


GRIDS = ("thesis",)
"""Grids of a statement: the thesis's own number of points, on which a number has no grid error."""
WITHOUT_INPUTS = [name for name in REDUCTIONS if not reduction_inputs(name)]
"""Reductions that look at one quantity, value by value."""
CLAIM_KEYS = {
    "source": Key(text, "where the thesis says so"),
    "statement": Key(text, "what the thesis says"),
    "rationale": Key(text, "why that band, or why there is no answer"),
    "study": Key(text, "the name of a study of this chapter, or left out where there is no answer", None),
    "formula": Key(choice(FORMULAS), f"one of {', '.join(FORMULAS)}, or left out", None),
    "relative_to": Key(text, "the name of a second study that divides, or left out", None),
    "minus": Key(text, "the name of a second study that is subtracted, or left out", None),
    "quantity": Key(text, "the name of a quantity", None),
    "beside": Key(text, "the name of a quantity that is judged beside it and not counted, or left out", None),
    "reduce": Key(choice((*REDUCTIONS, *ORDERS)), f"one of {', '.join((*REDUCTIONS, *ORDERS))}", None),
    "against": Key(text, "the name of a quantity", None),
    "along": Key(text, "a dimension of the study", None),
    "across": Key(text, "another dimension of the study", None),
    "select": Key(mapping, "a mapping from a dimension to its least and largest value", None),
    "expect": Key(number, "a number, with `tolerance`", None),
    "tolerance": Key(positive, "a positive number, with `expect`", None),
    "at_least": Key(number, "a number", None),
    "at_most": Key(number, "a number", None),
    "neutral": Key(number, "the value that the statement names, or that would mean no change", None),
    "absent": Key(text, "what a variant lacks that has no such number", None),
    "grid": Key(choice(GRIDS), f"one of {', '.join(GRIDS)}", None),
    "cases": Key(mapping, "a mapping from the name of a case to the keys that it replaces", None),
    "admissible": Key(mapping, "a mapping from what the text leaves open to its alternatives", None),
    "cause": Key(mapping, "a mapping with `kind` and `text`", None),
}
CAUSE_KEYS = {
    "kind": Key(choice(KINDS), f"one of {', '.join(KINDS)}"),
    "text": Key(text, "a short text with the number that shows it"),
}
REPLACED = ("study", "relative_to", "minus", "quantity", "reduce", "along", "against", "select")
CASE_KEYS = {key: CLAIM_KEYS[key] for key in REPLACED}
"""Keys that a further case of a statement may replace."""
CHOICE_KEYS = {key: CLAIM_KEYS[key] for key in (*REPLACED, "cases")}
"""Keys that an admissible alternative may replace."""
BANDS = ({"expect", "tolerance"}, {"at_least"}, {"at_most"})
"""Sets of keys that give a band."""
WITHOUT_STUDY = ("source", "statement", "rationale", "cause", "is_finding")
"""Settings of a claim that no study answers."""
WITH_FORMULA = (*WITHOUT_STUDY, "formula", "neutral", *sorted(set.union(*BANDS)))
"""Settings of a claim that an equation answers."""
INPUTS = ("against", "along", "across")
"""Keys that a reduction may need beside the quantity."""


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis: its name, and its settings as read."""

    name: str
    settings: dict

    @property
    def studies(self) -> list[str]:
        """Names of the studies that answer the claim: none, one, two for a comparison, those of cases and readings."""
        choices = [self.settings, *(self.settings["admissible"] or {}).values()]
        readings = [part for choice in choices for part in (choice, *(choice["cases"] or {}).values())]
        names = [reading[key] for reading in readings for key in ("study", *SECOND_STUDY)]
        return list(dict.fromkeys(name for name in names if name is not None))


def read_claim(name: str, section: object, file: object, studies: Mapping[str, Study], part: str = "claims") -> Claim:
    """Return a claim or a finding of a chapter's config, checked against the studies of that chapter.

    Parameters
    ----------
    name
        Name of the claim.
    section
        Its section of the config.
    file
        The file of the chapter.
    studies
        Studies of the chapter by name.
    part
        "claims", or "findings": numbers that no sentence of the thesis states, without a band.

    Raises
    ------
    InputError
        If a key is unknown, missing or of no use to the claim, or names what the studies do not have.
    """
    prefix = f"{part}.{name}"
    is_finding = part == "findings"
    settings = read(section, CLAIM_KEYS, file, prefix) | {"is_finding": is_finding}
    settings["cause"] = read_cause(settings["cause"], file, f"{prefix}.cause")
    if is_finding:
        _check_no_verdict(settings, file, prefix)
    if settings["formula"] is not None or (settings["study"] is None and not is_finding):
        _check_without_study(settings, file, prefix)
        return Claim(name, settings)
    alternatives, settings["admissible"] = settings["admissible"] or {}, None
    given = dict(settings)
    cases, settings["cases"] = settings["cases"] or {}, None
    _check_one_of(settings, "study", studies, file, prefix)
    claim = Claim(name, settings)
    dims = list(dict.fromkeys(dim for study in claim.studies for dim in _dimensions(studies, study)))
    _check_quantities(settings, studies, dims, file, prefix)
    settings["select"] = read_selection(settings["select"] or {}, dims, file, f"{prefix}.select")
    _check_band(settings, file, prefix)
    if settings["absent"] is not None and settings["reduce"] not in WITHOUT_INPUTS:
        raise InputError(f"{prefix}.absent", settings["absent"], f"with {', '.join(WITHOUT_INPUTS)} only", file)
    settings["cases"] = read_cases(given, cases, file, f"{prefix}.cases", studies)
    settings["admissible"] = read_alternatives(given, alternatives, file, f"{prefix}.admissible", studies)
    return claim


def read_cause(section: Mapping | None, file: object, prefix: str) -> dict[str, str] | None:
    """Return the cause of a failure as settings; None where the config gives none."""
    return None if section is None else asdict(Cause(**read(section, CAUSE_KEYS, file, prefix)))


def read_alternatives(
    claim: Mapping, section: Mapping, file: object, prefix: str, studies: Mapping[str, Study]
) -> dict[str, dict]:
    """Return the settings of the claim with each alternative for what the text leaves open, checked as a claim is.

    Parameters
    ----------
    claim
        Keys of the claim as given, with defaults.
    section
        By what is open, the alternatives by name: each a mapping of the keys that it replaces.
    file
        The file of the chapter.
    prefix
        Place of the section in the file.
    studies
        Studies of the chapter by name.
    """
    readings = {}
    for topic, alternatives in section.items():
        if not isinstance(alternatives, dict) or not alternatives:
            raise InputError(f"{prefix}.{topic}", alternatives, "a mapping from a name to the keys replaced", file)
        for name, replaced in alternatives.items():
            place = f"{prefix}.{topic}.{name}"
            readings[f"{topic}: {name}"] = _changed_claim(claim, replaced, CHOICE_KEYS, file, place, studies)
    return readings


def read_cases(
    claim: Mapping, section: Mapping, file: object, prefix: str, studies: Mapping[str, Study]
) -> dict[str, dict]:
    """Return the settings of the claim in each further case by its name, checked as a claim is; parameters as above."""
    without = {key: value for key, value in claim.items() if key != "cases"}
    return {
        name: _changed_claim(without, replaced, CASE_KEYS, file, f"{prefix}.{name}", studies)
        for name, replaced in section.items()
    }


def _changed_claim(
    claim: Mapping, replaced: object, allowed: Mapping[str, Key], file: object, place: str, studies: Mapping[str, Study]
) -> dict:
    """Return the settings of a claim with some keys replaced, checked as a claim is; `claim`: keys as given."""
    changes = {key: value for key, value in read(replaced, allowed, file, place).items() if value is not None}
    if not changes:
        raise InputError(place, replaced, f"at least one of {', '.join(allowed)}", file)
    dropped = {"is_finding", "cause"} | ({"beside"} if "quantity" in changes else set())
    given = {key: value for key, value in claim.items() if key not in dropped and value is not None}
    return read_claim(place.removeprefix("claims."), given | changes, file, studies).settings


def _check_without_study(settings: dict, file: object, prefix: str) -> None:
    """Raise InputError for a claim of an equation, or without an answer, with a key that it has no use for."""
    has_formula = settings["formula"] is not None
    allowed = WITH_FORMULA if has_formula else WITHOUT_STUDY
    for key in settings:
        if key not in allowed and settings[key] is not None:
            raise InputError(f"{prefix}.{key}", settings[key], "left out, for there is no study", file)
    if not has_formula:
        return
    _check_band(settings, file, prefix)
    if not settings["is_finding"] and settings["expect"] is None and settings["neutral"] is None:
        raise InputError(f"{prefix}.neutral", None, "a number, where an equation is held against an edge", file)


def _check_no_verdict(settings: dict, file: object, prefix: str) -> None:
    """Raise InputError for a finding with a key that speaks of a verdict."""
    for key in ("cases", "admissible", "cause"):
        if settings[key] is not None:
            raise InputError(f"{prefix}.{key}", settings[key], "left out: a finding has no verdict", file)


def _check_band(settings: dict, file: object, prefix: str) -> None:
    """Raise InputError for a band where there is no verdict or only a sense, and for a claim without one."""
    band = {key for key in set.union(*BANDS) if settings[key] is not None}
    unused = sorted(band) + ["neutral"] * (settings["neutral"] is not None)
    if settings["is_finding"]:
        if unused:
            raise InputError(prefix, unused, "no band: a finding is a number without a verdict", file)
        if settings["reduce"] in ORDERS:
            raise InputError(f"{prefix}.reduce", settings["reduce"], f"one of {', '.join(REDUCTIONS)}", file)
    elif settings["reduce"] in ORDERS:
        if unused:
            raise InputError(prefix, unused, f"no band: {settings['reduce']} has only a sense", file)
    elif band not in BANDS:
        raise InputError(prefix, sorted(band), "expect with tolerance, or at_least, or at_most", file)


def _dimensions(studies: Mapping[str, Study], name: str) -> list[str]:
    """Return the dimensions of a study without its members; none for an unknown study."""
    return [dim for dim in studies[name].dimensions if dim != "member"] if name in studies else []


def _check_quantities(settings: dict, studies: Mapping[str, Study], dims: list[str], file: object, prefix: str) -> None:
    """Raise InputError for a reduction, quantity or dimension that the claim's studies do not have."""
    study = studies[settings["study"]]
    own = quantities(study)
    seconds = [key for key in SECOND_STUDY if settings[key] is not None]
    if len(seconds) > 1:
        raise InputError(prefix, seconds, "one of them", file)
    shared = _shared_quantities(settings, seconds[0], studies, file, prefix) if seconds else own
    allowed = {"quantity": shared, "against": own, "along": dims, "across": dims}
    _check_one_of(settings, "reduce", [*REDUCTIONS, *ORDERS], file, prefix)
    inputs = reduction_inputs(settings["reduce"])
    for key in ("quantity", *inputs):
        _check_one_of(settings, key, allowed[key], file, prefix)
    if settings["beside"] is not None:
        _check_one_of(settings, "beside", [name for name in shared if name != settings["quantity"]], file, prefix)
    for key in INPUTS:
        if key not in inputs and settings[key] is not None:
            unused = f"left out: {settings['reduce']} does not use it"
            raise InputError(f"{prefix}.{key}", settings[key], unused, file)
    if seconds and settings["against"] is not None and not REDUCTIONS[settings["reduce"]].against_first:
        single = [name for name in (*REDUCTIONS, *ORDERS) if "against" not in reduction_inputs(name)]
        message = f"with `{seconds[0]}`, one of {', '.join(single)}"
        raise InputError(f"{prefix}.reduce", settings["reduce"], message, file)


def _shared_quantities(settings: dict, key: str, studies: Mapping[str, Study], file: object, prefix: str) -> list[str]:
    """Return the quantities that both studies of a comparison have; the second must be loaded in the same way."""
    study = studies[settings["study"]]
    alike = [name for name, other in studies.items() if other.dimensions[-1] == study.dimensions[-1]]
    others = [name for name in alike if name != settings["study"]]
    _check_one_of(settings, key, others, file, prefix)
    return sorted(set(quantities(study)) & set(quantities(studies[settings[key]])))


def _check_one_of(settings: dict, key: str, allowed: Iterable[str], file: object, prefix: str) -> None:
    """Raise InputError for a value that is not allowed."""
    if settings[key] not in allowed:
        raise InputError(f"{prefix}.{key}", settings[key], f"one of {', '.join(allowed)}", file)
