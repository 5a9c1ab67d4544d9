"""Names of the quantities that the dataset of a study holds or gives."""

from __future__ import annotations

from contactsim.analysis import costs
from contactsim.analysis.aggregate import ROLL_OFF
from contactsim.analysis.quantities import BAR_SHARES, CRACK_DEPARTURE, ERROR_BARS, FITTED, GRADIENT_DEFICITS
from contactsim.analysis.rough_readings import rough_path_of
from contactsim.observables.dataset_forms import AVERAGED
from contactsim.study.keys import ERROR_RUNS
from contactsim.study.kind_quantities import KIND_QUANTITIES
from contactsim.study.study import Study


def quantities(study: Study) -> list[str]:
    """Return the names of the quantities that the dataset of a study holds or gives."""
    if study.settings["path"] is not None:
        return _path_quantities(study)
    load = study.settings["load"]["name"]
    names = {*AVERAGED, "mean_pressure", load} - ({"kappa"} if load != "reduced_pressure" else set())
    if load == "contact_ratio":
        is_sphere = study.settings["surface"]["kind"] == "sphere"
        size = "contact_radius" if is_sphere else "half_width"
        names |= {size, f"{size}_subgrid", f"{size}_exact", "rms_gradient_exact", "kappa_r_exact"}
        names |= set() if is_sphere else {"half_width_array", "rms_gradient_array", "kappa_r_array"}
    names |= _error_names(study, names & {*AVERAGED}) | {*costs.QUANTITIES}
    if load == "reduced_pressure":
        names |= set(GRADIENT_DEFICITS)
    if ROLL_OFF in study.dimensions:
        names.add("height_distance")
    if study.dimensions == ["hurst_exponent", "member", "reduced_pressure"]:
        names |= set(FITTED)
    if study.settings["members"] > 1:
        names |= {bar for bar, name in BAR_SHARES.items() if name in names}
    return sorted(names)


def _path_quantities(study: Study) -> list[str]:
    """Return the summaries of a path, the errors measured of them, and the varied keys."""
    scene = study.runs()[0].setup.scene
    names = KIND_QUANTITIES[scene.kind].path_quantities(scene, study.dimensions)
    rough = rough_path_of(study.settings, "t" in scene.components)
    names |= set() if rough is None else rough.reading_names
    if study.settings["surface"]["kind"] == "cylinder" and "work_of_separation" in study.dimensions:
        names.add(CRACK_DEPARTURE)
    if study.settings["members"] > 1:
        names |= {bar for bar, name in ERROR_BARS.items() if name in names}
    return sorted(names | _error_names(study, names) | (set(study.dimensions) - {"member", "step"}))


def _error_names(study: Study, names: set[str]) -> set[str]:
    """Return the names of the errors of quantities that a study measures."""
    kinds = [error for part, (_, error, _) in ERROR_RUNS.items() if study.settings[part] is not None]
    return {f"{name}_{error}_error" for name in names for error in kinds}
