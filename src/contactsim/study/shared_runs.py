"""Runs that can take results of other runs: twins without what is negligible, and runs with loads of the same scene."""

from __future__ import annotations

from collections.abc import Iterable

from contactsim.error_control.effect_maps import neglect_effects
from contactsim.error_control.neglect import expected_neglect
from contactsim.provenance import canonical
from contactsim.study.run import Run
from contactsim.study.scenes import settings_of_single_loads
from contactsim.study.study import Study


def find_twins(studies: Iterable[Study]) -> dict[str, Run]:
    """Return the first run of the same study and member whose scene is the same without what is negligible, by stem."""
    twins: dict[str, Run] = {}
    first: dict[tuple[object, ...], Run] = {}
    for study in studies:
        for run in study.runs() if study.settings["auto"] else ():
            if "auto" in run.settings:
                effects = expected_neglect(run.setup.scene, study.settings["auto"]["neglect_within"])
                key = study.name, run.member, run.error, neglect_effects(run.setup, effects).fingerprint
                if effects and first.setdefault(key, run) is not run:
                    twins[run.stem] = first[key]
    return twins


def find_runs_alike(runs: Iterable[Run]) -> dict[str, list[str]]:
    """Return the stems of the other runs of any study of whose loads some may be those of a run, by its stem."""
    alike: dict[str, list[str]] = {}
    for run in runs:
        if settings := settings_of_single_loads(run.settings):
            alike.setdefault(canonical(settings), []).append(run.stem)
    shared = [stems for stems in alike.values() if len(stems) > 1]
    return {stem: [other for other in stems if other != stem] for stems in shared for stem in stems}
