"""Compute a run of a study to the accuracy that it asks for, into its files."""

from __future__ import annotations

import logging
import time

import xarray as xr

from contactsim.error_control.ladder import solve_to_error
from contactsim.paths.options import Setup
from contactsim.status import warn_of_excess
from contactsim.study.execute import RunFiles, keep_run
from contactsim.study.scenes import build_setup, updated_settings

logger = logging.getLogger(__name__)


def run(settings: dict, source: str, files: RunFiles, threads: int = 1) -> None:
    """Compute a run to its accuracy, into its dataset and costs; parameters as in `execute.run`."""
    begin = time.process_time()
    data, settings = compute(build_setup(settings, threads), settings, source, files)
    keep_run(data, settings, source, files, begin)


def compute(setup: Setup, settings: dict, source: str, files: RunFiles) -> tuple[xr.Dataset, dict]:
    """Return the dataset of a run to its accuracy, and its settings with the grid that this took."""
    accuracy = settings["accuracy"]
    controlled = solve_to_error(setup, accuracy["error"], tuple(accuracy["quantities"]))
    if not controlled.met:
        logger.warning("an accuracy of %g is not reached: %s", controlled.wanted, controlled.summary)
    warn_of_excess(controlled.data)
    return controlled.data, updated_settings(settings, controlled.last.setup)
