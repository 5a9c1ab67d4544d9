"""What every job does first and last: it opens its log and checks what it reads, and seals what it wrote."""

from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from contactsim.errors import InputError
from contactsim.provenance import digest
from contactsim.seals import Seal, check_inputs, content_digest

MADE_FROM = ("plan", "source", "tier")
"""Parameters of rules on which results depend."""


def open_job(snakemake: Any) -> Callable[[], None]:
    """Open the log of a job and check what it reads; return what seals its outputs, its last step.

    Log lines, warnings and tracebacks of this process go to the log as they come.
    """
    stream = open(snakemake.log[0], "w", buffering=1, encoding="utf-8")  # noqa: SIM115 - stays open for the job's life
    sys.stdout = sys.stderr = stream
    logging.basicConfig(stream=stream, level="INFO", format="%(asctime)s %(levelname)s %(message)s")
    logging.getLogger("fontTools").setLevel("WARNING")
    logging.captureWarnings(True)
    results = results_of(snakemake)
    inputs = check_inputs(results, map(Path, snakemake.input))

    def seal() -> None:
        """Seal what the job wrote."""
        outputs = {str(path.relative_to(results)): content_digest(path) for path in map(Path, snakemake.output)}
        made_from = parameters_digest(dict(snakemake.params.items()))
        Seal(snakemake.rule, dict(snakemake.wildcards.items()), made_from, inputs, outputs).write(results)

    return seal


def is_sound(results: Path, paths: Iterable[Path]) -> bool:
    """Return True where results are there, and as they were when they were made."""
    try:
        return bool(check_inputs(results, paths))
    except InputError:
        return False


def made_from(parameters: dict[str, Any]) -> dict[str, Any]:
    """Return the parameters of a rule on which its results depend."""
    return {name: value for name, value in parameters.items() if name in MADE_FROM}


def parameters_digest(parameters: dict[str, Any]) -> str:
    """Return the digest of the parameters of a rule on which its results depend."""
    return digest(made_from(parameters))


def results_of(snakemake: Any) -> Path:
    """Return the folder of the tier whose job this is; logs stand in a folder of it."""
    logs = next(folder for folder in Path(snakemake.log[0]).parents if folder.name == "logs")
    return logs.parent
