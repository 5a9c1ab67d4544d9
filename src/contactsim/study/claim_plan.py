"""Claims as the config gives them: a quantity, its reduction to one number, and the band that the thesis states."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass

from contactsim.analysis.causes import PERCENT, ROW_NUMBERS, Cause
from contactsim.analysis.comparison import SECOND_STUDY, studies_of
from contactsim.analysis.reductions import ORDERS
from contactsim.errors import InputError
from contactsim.study.claim_checks import (
    check_band,
    check_more_members,
    check_no_verdict,
    check_one_of,
    check_quantities,
    check_without_study,
    study_dimensions,
)
from contactsim.study.claim_keys import (
    CASE_KEYS,
    CAUSE_KEYS,
    CELL_KEYS,
    CHOICE_KEYS,
    CLAIM_KEYS,
    DATA_KEYS,
    EDGES,
    MEASURE_KEYS,
    NUMBER_KEYS,
    WITHOUT_INPUTS,
)
from contactsim.study.reading import Key, interval, read
from contactsim.study.study import Study


def read_selection(section: Mapping, dims: Iterable[str], file: object, prefix: str) -> dict[str, list[float]]:
    """Return the smallest and largest value of each dimension that the section selects.

    Raises
    ------
    InputError
        If a key is not one of `dims` or a value is not an interval.
    """
    keys = dict.fromkeys(dims, Key(interval, "least and largest value", None))
    return {dim: ends for dim, ends in read(section, keys, file, prefix).items() if ends is not None}


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
        cause = self.settings["cause"]
        readings += cause["numbers"].values() if cause else []
        return list(dict.fromkeys(name for reading in readings for name in _studies_read(reading)))


def _studies_read(settings: Mapping) -> list[str]:
    """Return the names of the studies that a reading compares, and of those that it takes members from."""
    return [*studies_of(settings), *(settings["more_members"] or ())]


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
    return Claim(name, _read_settings(f"{part}.{name}", section, file, studies, part == "findings"))


def _read_settings(
    prefix: str, section: object, file: object, studies: Mapping[str, Study], is_finding: bool = False
) -> dict:
    """Return the checked settings of a claim, or of a number without a verdict; prefix: place of the section."""
    settings = read(section, CLAIM_KEYS, file, prefix) | {"is_finding": is_finding}
    if is_finding:
        check_no_verdict(settings, file, prefix)
    settings["cause"] = read_cause(settings, file, f"{prefix}.cause", studies)
    if settings["formula"] is not None or (settings["study"] is None and not is_finding):
        check_without_study(settings, file, prefix)
        return settings
    alternatives, settings["admissible"] = settings["admissible"] or {}, None
    entries = dict(settings)
    cases, settings["cases"] = settings["cases"] or {}, None
    if cases and (settings["case"] is None or settings["case"] in cases):
        raise InputError(f"{prefix}.case", settings["case"], "a name of the claim's own case beside `cases`", file)
    check_one_of(settings, "study", studies, file, prefix)
    dims = list(dict.fromkeys(dim for study in studies_of(settings) for dim in study_dimensions(studies, study)))
    check_quantities(settings, studies, dims, file, prefix)
    check_more_members(settings, studies, file, prefix)
    settings["select"] = read_selection(settings["select"] or {}, dims, file, f"{prefix}.select")
    all_dims = list(dict.fromkeys(dim for study in studies for dim in study_dimensions(studies, study)))
    for dim in settings["whole"] or ():
        if dim not in all_dims:  # of any study: another reading may be answered by one that lacks it
            raise InputError(f"{prefix}.whole", dim, f"one of {', '.join(all_dims)}", file)
    check_band(settings, file, prefix)
    if settings["absent"] is not None and settings["reduce"] not in WITHOUT_INPUTS:
        raise InputError(f"{prefix}.absent", settings["absent"], f"with {', '.join(WITHOUT_INPUTS)} only", file)
    settings["cases"] = read_cases(entries, cases, file, f"{prefix}.cases", studies)
    settings["admissible"] = read_alternatives(entries, alternatives, file, f"{prefix}.admissible", studies)
    return settings


def read_cause(claim: Mapping, file: object, prefix: str, studies: Mapping[str, Study]) -> dict | None:
    """Return the cause of a claim's failure as settings; None where the config gives none.

    Parameters
    ----------
    claim
        Keys of the claim as given, with defaults.
    file
        The file of the chapter.
    prefix
        Place of the cause in the file.
    studies
        Studies of the chapter by name.

    Raises
    ------
    InputError
        If a key is unknown or missing, or the text names a number in braces that there is not.
    """
    if claim["cause"] is None:
        return None
    settings = read(claim["cause"], CAUSE_KEYS, file, prefix)
    settings["numbers"] = {
        name: _read_number(claim, replaced, file, f"{prefix}.numbers.{name}", studies)
        for name, replaced in settings["numbers"].items()
    }
    if settings["cell"] is not None:
        exponents = read(settings["cell"], CELL_KEYS, file, f"{prefix}.cell")
        settings["cell"] = {name: power for name, power in exponents.items() if power is not None}
    cause = Cause(**settings)
    try:
        numbers = cause.named_numbers
    except ValueError as error:
        raise InputError(f"{prefix}.text", cause.text, f"braces that match ({error})", file) from error
    for name, form in numbers:
        if name not in cause.known_names:
            raise InputError(f"{prefix}.text", name, f"in braces one of {', '.join(cause.known_names)}", file)
        if form not in ("", PERCENT) or (form and name not in (*ROW_NUMBERS, *cause.numbers)):
            raise InputError(f"{prefix}.text", f"{name}:{form}", f"no format, or `{PERCENT}` of a number", file)
    for name in settings["numbers"]:
        if name not in dict(numbers):
            raise InputError(f"{prefix}.numbers.{name}", settings["numbers"][name], "used in `text`", file)
    return asdict(cause)


def _read_number(claim: Mapping, replaced: object, file: object, place: str, studies: Mapping[str, Study]) -> dict:
    """Return the settings of a number of a cause, checked as a finding is.

    It has the keys of the claim where it does not replace them. With another study it keeps no selection and no second
    study of the claim; with another reduction it keeps no dimension and no quantity that the claim's one needs.
    """
    changes = {key: value for key, value in read(replaced, NUMBER_KEYS, file, place).items() if value is not None}
    if not changes:
        raise InputError(place, replaced, f"at least one of {', '.join(NUMBER_KEYS)}", file)
    own_keys = set(NUMBER_KEYS) - {"absent"}
    for first, keys in (("study", DATA_KEYS), ("reduce", MEASURE_KEYS)):
        own_keys -= {*keys} if first in changes else set()
    words = ("source", "statement", "rationale")
    entries = {key: claim[key] for key in (*words, *own_keys) if claim[key] is not None}
    return _read_settings(place, entries | changes, file, studies, is_finding=True)


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
    dropped = {"is_finding", "cause"} | ({"beside"} if {"quantity", "against"} & set(changes) else set())
    if {"study", *SECOND_STUDY} & set(changes):
        dropped |= {"more_members"}
    if "expect" in changes:
        dropped |= {*EDGES}
    elif {*EDGES} & set(changes) or changes.get("reduce") in ORDERS:  # an order has a sense and no band
        dropped |= {"expect", "tolerance", *EDGES}
    entries = {key: value for key, value in claim.items() if key not in dropped and value is not None}
    return _read_settings(place, entries | changes, file, studies)
