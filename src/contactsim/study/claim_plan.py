"""Claims as the config gives them: a quantity, its reduction to one number, and the band that the thesis states."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from contactsim.analysis.comparison import SECOND_STUDY
from contactsim.analysis.quantities import FITTED
from contactsim.analysis.reductions import ORDERS, REDUCTIONS, reduction_inputs
from contactsim.errors import InputError
from contactsim.observables.dataset_forms import AVERAGED
from contactsim.study.keys import ERROR_RUNS
from contactsim.study.kinds import study_kind
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
}
BANDS = ({"expect", "tolerance"}, {"at_least"}, {"at_most"})
"""Sets of keys that give a band."""
INPUTS = ("against", "along", "across")
"""Keys that a reduction may need beside the quantity."""


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis: its name, and its settings as read."""

    name: str
    settings: dict

    @property
    def studies(self) -> list[str]:
        """Names of the studies that answer the claim: none, one, or two for a comparison."""
        return [self.settings[key] for key in ("study", *SECOND_STUDY) if self.settings[key] is not None]


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
    if settings["study"] is None and not is_finding:
        for key in settings:
            if key not in ("source", "statement", "rationale", "is_finding") and settings[key] is not None:
                raise InputError(f"{prefix}.{key}", settings[key], "left out, for there is no study", file)
        return Claim(name, settings)
    _check_one_of(settings, "study", studies, file, prefix)
    claim = Claim(name, settings)
    dims = list(dict.fromkeys(dim for study in claim.studies for dim in _dimensions(studies, study)))
    _check_quantities(settings, studies, dims, file, prefix)
    settings["select"] = read_selection(settings["select"] or {}, dims, file, f"{prefix}.select")
    _check_band(settings, file, prefix)
    if settings["absent"] is not None and settings["reduce"] not in WITHOUT_INPUTS:
        raise InputError(f"{prefix}.absent", settings["absent"], f"with {', '.join(WITHOUT_INPUTS)} only", file)
    return claim


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
    if seconds and settings["against"] is not None:
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


def quantities(study: Study) -> list[str]:
    """Return the names of the quantities that the dataset of a study holds or gives."""
    if study.settings["path"] is not None:
        return _path_quantities(study)
    load = study.settings["load"]["name"]
    names = {*AVERAGED, "mean_pressure", load} - ({"kappa"} if load != "reduced_pressure" else set())
    if load == "contact_ratio":
        is_sphere = study.settings["surface"]["kind"] == "sphere"
        size = "contact_radius" if is_sphere else "half_width"
        names |= {size, f"{size}_subgrid", f"{size}_exact", "rms_gradient_exact"}
        names |= set() if is_sphere else {"half_width_array", "rms_gradient_array", "kappa_r_array"}
    names |= _error_names(study, names & {*AVERAGED})
    if study.dimensions == ["hurst_exponent", "member", "reduced_pressure"]:
        names |= set(FITTED)
    return sorted(names)


def _path_quantities(study: Study) -> list[str]:
    """Return the summaries of a path, the errors measured of them, and the varied keys."""
    scene = study.runs()[0].setup.scene
    names = study_kind(study.settings).path_quantities(scene, study.dimensions)
    return sorted(names | _error_names(study, names) | (set(study.dimensions) - {"member", "step"}))


def _error_names(study: Study, names: set[str]) -> set[str]:
    """Return the names of the errors of quantities that a study measures."""
    kinds = [error for part, (_, error, _) in ERROR_RUNS.items() if study.settings[part] is not None]
    return {f"{name}_{error}_error" for name in names for error in kinds}
