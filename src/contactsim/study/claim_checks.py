"""Check the settings of a claim against each other and against the studies that answer it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from contactsim.analysis.carried import CARRIED
from contactsim.analysis.comparison import SECOND_STUDY
from contactsim.analysis.quantities import GRADIENT_DEFICITS, SIZES
from contactsim.analysis.reductions import ORDERS, REDUCTIONS, reduction_inputs
from contactsim.errors import InputError
from contactsim.observables.body_readings import CURVES
from contactsim.observables.dataset_forms import AVERAGED, KEPT_NUMBERS
from contactsim.study.quantity_names import quantities
from contactsim.study.study import Study

BANDS = ({"expect", "tolerance"}, {"at_least"}, {"at_most"})
"""Sets of keys that give a band."""
WITHOUT_STUDY = ("source", "statement", "rationale", "cause", "is_finding")
"""Settings of a claim that no study answers."""
WITH_FORMULA = (*WITHOUT_STUDY, "formula", "neutral", *sorted(set.union(*BANDS)))
"""Settings of a claim that an equation answers."""
INPUTS = ("against", "along", "across")
"""Keys that a reduction may need beside the quantity."""


def check_without_study(settings: dict, file: object, prefix: str) -> None:
    """Raise InputError for a claim of an equation, or without an answer, with a key that it has no use for."""
    has_formula = settings["formula"] is not None
    allowed = WITH_FORMULA if has_formula else WITHOUT_STUDY
    for key in settings:
        if key not in allowed and settings[key] is not None:
            raise InputError(f"{prefix}.{key}", settings[key], "left out, for there is no study", file)
    if not has_formula:
        return
    check_band(settings, file, prefix)
    if not settings["is_finding"] and settings["expect"] is None and settings["neutral"] is None:
        raise InputError(f"{prefix}.neutral", None, "a number, where an equation is held against an edge", file)


def check_no_verdict(settings: dict, file: object, prefix: str) -> None:
    """Raise InputError for a finding with a key that speaks of a verdict."""
    for key in ("cases", "admissible", "cause"):
        if settings[key] is not None:
            raise InputError(f"{prefix}.{key}", settings[key], "left out: a finding has no verdict", file)


def check_band(settings: dict, file: object, prefix: str) -> None:
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


def study_dimensions(studies: Mapping[str, Study], name: str) -> list[str]:
    """Return the dimensions of a study without its members; none for an unknown study."""
    return [dim for dim in studies[name].dimensions if dim != "member"] if name in studies else []


def check_quantities(settings: dict, studies: Mapping[str, Study], dims: list[str], file: object, prefix: str) -> None:
    """Raise InputError for a reduction, quantity or dimension that the claim's studies do not have."""
    study = studies[settings["study"]]
    own = quantities(study)
    seconds = [key for key in SECOND_STUDY if settings[key] is not None]
    if len(seconds) > 1:
        raise InputError(prefix, seconds, "one of them", file)
    shared = _shared_quantities(settings, seconds[0], studies, file, prefix) if seconds else own
    if seconds == ["departs_from"]:
        shared = [name for name in shared if name in CURVES]
    elif settings["reduce"] == "largest_difference":
        raise InputError(f"{prefix}.departs_from", None, "a study, for `largest_difference` counts its curve", file)
    allowed = {"quantity": shared, "against": own, "along": dims, "across": dims}
    check_one_of(settings, "reduce", [*REDUCTIONS, *ORDERS], file, prefix)
    inputs = reduction_inputs(settings["reduce"])
    for key in ("quantity", *inputs):
        check_one_of(settings, key, allowed[key], file, prefix)
    if settings["beside"] is not None:
        check_one_of(settings, "beside", [name for name in shared if name != settings["quantity"]], file, prefix)
    if settings["grid"] == "thesis":
        check_thesis_grid(settings, [studies[settings[key]] for key in ("study", *seconds)], file, prefix)
    for key in INPUTS:
        if key not in inputs and settings[key] is not None:
            unused = f"left out: {settings['reduce']} does not use it"
            raise InputError(f"{prefix}.{key}", settings[key], unused, file)
    if seconds and settings["against"] is not None and not REDUCTIONS[settings["reduce"]].against_first:
        single = [name for name in (*REDUCTIONS, *ORDERS) if "against" not in reduction_inputs(name)]
        message = f"with `{seconds[0]}`, one of {', '.join(single)}"
        raise InputError(f"{prefix}.reduce", settings["reduce"], message, file)


def check_more_members(settings: dict, studies: Mapping[str, Study], file: object, prefix: str) -> None:
    """Raise InputError for `more_members` that are not those of a compared study, or cannot be transferred to it."""
    compared = [studies[settings[key]] for key in ("study", *SECOND_STUDY) if settings[key] is not None]
    for name in settings["more_members"] or ():
        names = [more.name for more in studies.values() if any(_has_more_members(more, study) for study in compared)]
        if name not in names:
            allowed = "studies of the same surfaces and effects with more members on no more points, the fewest first"
            raise InputError(f"{prefix}.more_members", name, f"{allowed}; here: {', '.join(names) or 'none'}", file)
        compared = [studies[name] if _has_more_members(studies[name], study) else study for study in compared]
        for key in ("quantity", "against", "beside"):
            if settings[key] is not None:
                check_one_of(settings, key, _transferable_quantities(studies[name]), file, prefix)


def _has_more_members(study: Study, reference: Study) -> bool:
    """Return True if a study has more of the surfaces of another one, of which two or more can be compared with it.

    Both need a load and a variant in common, and the same bodies and effects under loads of the same kind.
    """
    settings, others = study.settings, reference.settings
    alike = study.surfaces_of == reference.surfaces_of and study.dimensions == reference.dimensions
    alike &= all(settings[key] == others[key] for key in ("surface", "body", "counter_body", "effects"))
    if not alike or settings["path"] is not None or "points" in study.dimensions:
        return False
    shared = [{*settings["load"]["values"]} & {*others["load"]["values"]}]
    shared += [{*values} & {*others["vary"][key]} for key, values in settings["vary"].items()]
    return all(shared) and settings["points"] <= others["points"] and settings["members"] > others["members"] >= 2


def _transferable_quantities(study: Study) -> list[str]:
    """Return the quantities of a study that are functions of means over its members."""
    means = {*AVERAGED, *CARRIED, *SIZES, *GRADIENT_DEFICITS, *study.dimensions} - {*KEPT_NUMBERS}
    return [name for name in quantities(study) if name in means]


def check_thesis_grid(settings: dict, compared: Iterable[Study], file: object, prefix: str) -> None:
    """Raise InputError for a number on the thesis's grid that a study lacks, or that cannot be carried to it."""
    for study in compared:
        if study.settings["thesis_points"] is None:
            raise InputError(f"{prefix}.grid", settings["grid"], f"left out: {study.name} has no thesis_points", file)
    if settings["beside"] is not None:
        check_one_of(settings, "quantity", CARRIED.values(), file, prefix)
        if settings["against"] is not None:
            raise InputError(f"{prefix}.against", settings["against"], "left out with `grid` and `beside`", file)


def _shared_quantities(settings: dict, key: str, studies: Mapping[str, Study], file: object, prefix: str) -> list[str]:
    """Return the quantities that both studies of a comparison have; the second must be loaded in the same way."""
    study = studies[settings["study"]]
    alike = [name for name, other in studies.items() if other.dimensions[-1] == study.dimensions[-1]]
    others = [name for name in alike if name != settings["study"]]
    check_one_of(settings, key, others, file, prefix)
    return sorted(set(quantities(study)) & set(quantities(studies[settings[key]])))


def check_one_of(settings: dict, key: str, allowed: Iterable[str], file: object, prefix: str) -> None:
    """Raise InputError for a value that is not allowed."""
    if settings[key] not in allowed:
        raise InputError(f"{prefix}.{key}", settings[key], f"one of {', '.join(allowed)}", file)
