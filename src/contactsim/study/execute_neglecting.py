"""Compute a run of a study without the effects that were found negligible, into its files."""

from __future__ import annotations

import json
import logging
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from contactsim import dataset
from contactsim.error_control.effect_maps import neglect_effects
from contactsim.paths.options import Setup
from contactsim.study import execute, execute_to_accuracy
from contactsim.study.execute import RunFiles, keep_run
from contactsim.study.scenes import build_setup

logger = logging.getLogger(__name__)

FROM_ACCURACY = ("points", "tolerance", "load", "increments")
"""Settings that a run to an accuracy may have changed."""


@dataclass(frozen=True)
class Neglected:
    """Effects that a run neglects, as its dataset tells.

    Parameters
    ----------
    effects : list of str
        Effects that are neglected.
    notes : mapping
        Variables that are added to the dataset.
    """

    effects: list[str]
    notes: Mapping[str, object]

    @classmethod
    def read(cls, file: str | Path, setup: Setup, member: int) -> Neglected:
        """Return the decision in a file; the first member bears the work of the check."""
        decision = json.loads(Path(file).read_text(encoding="utf-8"))
        notes = {
            "neglected": ", ".join(decision["neglected"]),
            "neglect_change": decision["together"],
            "decision": decision["description"],
            "check_transforms": decision["work"] / setup.size if member == 0 else 0.0,
        }
        return cls(decision["neglected"], notes)


def run(
    settings: dict,
    source: str,
    files: RunFiles,
    decision: str | Path,
    twin: str | Path | None = None,
    threads: int = 1,
) -> None:
    """Compute a run without negligible effects, into its dataset and costs; other parameters as in `execute.run`.

    Parameters
    ----------
    decision : path
        File that says which effects are neglected.
    twin : path, optional
        Dataset of a run whose scene is the same without the effects that the maps find negligible. It is taken over
        where they were neglected in both.
    """
    begin = time.process_time()
    setup = build_setup(settings, threads)
    neglected = Neglected.read(decision, setup, settings["member"])
    settings = settings | {"neglect": neglected.effects}
    if twin is not None and _take_over(twin, settings, source, files, neglected.notes):
        return
    compute = execute.compute if setup.options.accuracy is None else execute_to_accuracy.compute
    data, settings = compute(neglect_effects(setup, neglected.effects), settings, source, files)
    keep_run(data.assign(neglected.notes), settings, source, files, begin)


def _take_over(twin: str | Path, settings: dict, source: str, files: RunFiles, notes: Mapping[str, object]) -> bool:
    """Write the dataset of another run as that of this one if their scenes are the same; nothing is spent."""
    begin = time.process_time()
    data = dataset.load_dataset(twin)
    other = dataset.settings_of(data)
    settings = settings | {name: other[name] for name in FROM_ACCURACY if name in other}
    if build_setup(other).fingerprint != build_setup(settings).fingerprint:
        return False
    (dim,) = data.transforms.dims
    spent = {name: data[name] * 0 for name in ("transforms", "coarse_run_transforms") if name in data}
    data = data.drop_vars("point_digest").assign(spent | dict(notes)).assign(seconds=(dim, np.zeros(data[dim].size)))
    data = data if dim == "step" else data.rename({dim: "step"})
    logger.info("taken over from a run whose scene is the same without %s", notes["neglected"])
    keep_run(data, settings, source, files, begin)
    return True
