"""What the thesis states, held against the datasets: value, errors and verdict of each claim.

A claim in the config names a quantity, how it is reduced to one number, and the band in which the statement puts that
number. Its verdict is computed, never written down, and depends on three things: the number from the ensemble means,
its ensemble error (jackknife over members) and its grid error (change when all means move by theirs). Of the grid
error only the size is stored. Of rough lines its sign was the same at every load and H, so all points of a quantity
move together, and of two quantities the worse of all combinations counts. Of a cylinder, where it is the rounding of
two edges to grid points, that understates the error of a spread.

The rule: let e be both errors in quadrature and d the distance from the number to the nearest edge of the band. With
e ≥ d, or with either unknown, the statement is not decidable: a finer grid or more members could turn the verdict.
Otherwise it is reproduced inside the band and not reproduced outside. Where the whole selection does not reproduce it
but a narrower condition does, it is reproduced with a condition; where the whole is not decidable and the condition
does not reproduce it, it is not reproduced. The condition may be part of the loads or variants,
or the thesis's own grid: then the number is compared with the thesis's at equal resolution, and its grid error does
not count. A statement about that grid itself is not decidable on another. Errors are one standard error, so a number
near an edge is decided wrongly about one time in six; and noise adds to every spread, which works against statements
that something is constant. A study without chance in it has no ensemble error, and its grid error alone decides.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.reductions import TAKES, needs, quantities
from contactsim.analysis.uncertainty import Finding, find
from contactsim.errors import SceneError
from contactsim.study.reading import Key, choice, mapping, number, positive, read, text
from contactsim.study.study import Study

REPRODUCED, CONDITION = "reproduced", "reproduced with a condition"
NOT_REPRODUCED, NOT_DECIDABLE = "not reproduced", "not decidable"
NAN = float("nan")


def limits(value: object) -> list[float]:
    """Two numbers, the least first."""
    if not isinstance(value, list) or len(value) != 2 or number(value[0]) > number(value[1]):
        raise ValueError
    return [number(entry) for entry in value]


def selection(section: dict, dims: list[str], file: object, prefix: str) -> dict:
    """Least and largest value of some of these dimensions."""
    keys = dict.fromkeys(dims, Key(limits, "least and largest value", None))
    return {dim: ends for dim, ends in read(section, keys, file, prefix).items() if ends is not None}


CLAIM_KEYS = {
    "source": Key(text, "where the thesis says so"),
    "statement": Key(text, "what the thesis says"),
    "because": Key(text, "why that band, or why there is no answer"),
    "study": Key(text, "the name of a study of this chapter, or left out where there is no answer", None),
    "over": Key(text, "the name of a second study, or left out", None),
    "of": Key(text, "the name of a quantity", None),
    "take": Key(choice(TAKES), f"one of {', '.join(TAKES)}", None),
    "against": Key(text, "the name of a quantity", None),
    "along": Key(text, "a dimension of the study", None),
    "across": Key(text, "another dimension of the study", None),
    "select": Key(mapping, "a mapping from a dimension to its least and largest value", None),
    "expect": Key(number, "a number, with `within`", None),
    "within": Key(positive, "a positive number, with `expect`", None),
    "at_least": Key(number, "a number", None),
    "at_most": Key(number, "a number", None),
    "grid": Key(choice(("thesis",)), "thesis, where the statement is about its own number of points", None),
    "condition": Key(mapping, "a mapping with `words` and `select` or `grid`", None),
}
CONDITION_KEYS = {
    "words": Key(text, "the condition in words"),
    "select": Key(mapping, "a mapping from a dimension to its least and largest value", {}),
    "grid": Key(choice(("thesis",)), "thesis, for its own number of points", None),
}
BANDS = ({"expect", "within"}, {"at_least"}, {"at_most"})


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis: name, and its settings as read."""

    name: str
    settings: dict

    @classmethod
    def read(cls, name: str, section: object, file: object, studies: Mapping[str, Study]) -> Claim:
        """Check a claim of a chapter's config against the studies of that chapter."""
        prefix = f"claims.{name}"
        settings = read(section, CLAIM_KEYS, file, prefix)
        if settings["study"] is None:
            for key in settings:
                if key not in ("source", "statement", "because") and settings[key] is not None:
                    raise SceneError(f"{prefix}.{key}", settings[key], "left out, for there is no study", file)
            return cls(name, settings)
        _one_of(settings, "study", studies, file, prefix)
        study = studies[settings["study"]]
        shared = quantities(study) if settings["over"] is None else _shared(settings, studies, file, prefix)
        asked = [studies[settings[key]] for key in ("study", "over") if settings[key] is not None]
        dims = list(dict.fromkeys(dim for one in asked for dim in one.dimensions if dim != "member"))
        known = {"of": shared, "take": list(TAKES), "against": quantities(study), "along": dims, "across": dims}
        _one_of(settings, "take", known["take"], file, prefix)
        for key in ("of", *needs(settings["take"])):
            _one_of(settings, key, known[key], file, prefix)
        for key in ("against", "along", "across"):
            if key not in needs(settings["take"]) and settings[key] is not None:
                allowed = f"left out: {settings['take']} does not use it"
                raise SceneError(f"{prefix}.{key}", settings[key], allowed, file)
        if settings["over"] is not None and settings["against"] is not None:
            single = [take for take in TAKES if "against" not in needs(take)]
            raise SceneError(f"{prefix}.take", settings["take"], f"with `over`, one of {', '.join(single)}", file)
        settings["select"] = selection(settings["select"] or {}, dims, file, f"{prefix}.select")
        if settings["condition"] is not None:
            condition = read(settings["condition"], CONDITION_KEYS, file, f"{prefix}.condition")
            condition["select"] = selection(condition["select"], dims, file, f"{prefix}.condition.select")
            settings["condition"] = condition
        given = {key for key in set.union(*BANDS) if settings[key] is not None}
        if given not in BANDS:
            raise SceneError(prefix, sorted(given), "expect with within, or at_least, or at_most", file)
        return cls(name, settings)

    @property
    def studies(self) -> list[str]:
        """The studies whose data answer it: none, one, or two of which it takes the ratio."""
        return [self.settings[key] for key in ("study", "over") if self.settings[key] is not None]


def _shared(settings: dict, studies: Mapping[str, Study], file: object, prefix: str) -> list[str]:
    """Quantities that both studies of a ratio answer for; the second must be loaded in the same way."""
    study = studies[settings["study"]]
    alike = [name for name, other in studies.items() if other.dimensions[-1] == study.dimensions[-1]]
    _one_of(settings, "over", [name for name in alike if name != settings["study"]], file, prefix)
    return sorted(set(quantities(study)) & set(quantities(studies[settings["over"]])))


def _one_of(settings: dict, key: str, known: object, file: object, prefix: str) -> None:
    if settings[key] not in known:
        raise SceneError(f"{prefix}.{key}", settings[key], f"one of {', '.join(known)}", file)


def measure(claim: Mapping) -> str:
    """What is compared, in the names of the config."""
    if claim["study"] is None:
        return ""
    given = [f" {need} {claim[need]}" for need in needs(claim["take"])]
    ratio = "" if claim["over"] is None else f" in {claim['study']} over {claim['over']}"
    return f"{claim['take']} of {claim['of']}{ratio}{''.join(given)}"


def band(claim: Mapping) -> tuple[float, float]:
    """Least and largest value that the statement allows."""
    if claim["expect"] is not None:
        return claim["expect"] - claim["within"], claim["expect"] + claim["within"]
    return tuple(
        default if claim[key] is None else claim[key] for key, default in (("at_least", -np.inf), ("at_most", np.inf))
    )


def expected(claim: Mapping) -> str:
    """The band in words."""
    if claim["expect"] is not None:
        return f"{claim['expect']:g} ± {claim['within']:g}"
    signs = (("at_least", "≥"), ("at_most", "≤"))
    return " ".join(f"{sign} {claim[key]:g}" for key, sign in signs if claim[key] is not None)


def verdict(claim: Mapping, found: Finding) -> str:
    """Reproduced, not reproduced or not decidable: the rule of the module."""
    low, high = band(claim)
    distance = min(abs(found.value - low), abs(found.value - high))
    if not distance > math.hypot(found.ensemble_error, found.grid_error):
        return NOT_DECIDABLE
    return REPRODUCED if low < found.value < high else NOT_REPRODUCED


def judge(claim: Mapping, data: Sequence[xr.Dataset]) -> dict:
    """A claim's number, errors and verdict, and those under its condition where that decides it; data: as in `find`."""
    found = find(claim, data) if data else Finding()
    row = {"verdict": verdict(claim, found), **vars(found), "condition": "", "condition_value": NAN}
    row |= {"condition_ensemble_error": NAN, "condition_grid_error": NAN}
    if data and claim["condition"] is not None and row["verdict"] != REPRODUCED:
        narrower = find(claim, data, claim["condition"])
        decided = {REPRODUCED: CONDITION, NOT_REPRODUCED: NOT_REPRODUCED}.get(verdict(claim, narrower))
        if decided == CONDITION or (decided and row["verdict"] == NOT_DECIDABLE):
            row |= {f"condition_{name}": value for name, value in vars(narrower).items()}
            row |= {"verdict": decided, "condition": claim["condition"]["words"]}
    return row


def verdicts(claims: Mapping[str, Mapping], data: Mapping[str, xr.Dataset]) -> pd.DataFrame:
    """All claims of a chapter, one a row; data: the datasets by study."""
    rows = []
    for name, claim in claims.items():
        words = {key: claim[key] for key in ("source", "statement")} | {
            "measure": measure(claim),
            "expected": expected(claim),
        }
        studies = {key: claim[key] or "" for key in ("study", "over")}
        found = judge(claim, [data[study] for study in studies.values() if study])
        rows.append({"claim": name, **words, **found, "because": claim["because"], **studies})
    return pd.DataFrame(rows)
