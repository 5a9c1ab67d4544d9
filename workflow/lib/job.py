"""What every job does first and last: it opens its log and checks what it reads, and seals what it wrote."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import Any

from contactsim.provenance import digest
from contactsim.seals import Seal, check_inputs, content_digest

MADE_FROM = ("plan", "source", "tier")
"""Parameters of rules on which results depend."""


def open_job(snakemake: Any) -> None:
    """Send log lines, warnings and tracebacks of this process to the log as they come; check what the job reads."""
    path = snakemake.log[0]
    stream = open(path, "w", buffering=1, encoding="utf-8")  # noqa: SIM115 - stays open for the life of the job
    sys.stdout = sys.stderr = stream
    logging.basicConfig(stream=stream, level="INFO", format="%(asctime)s %(levelname)s %(message)s")
    logging.getLogger("fontTools").setLevel("WARNING")
    logging.captureWarnings(True)
    check_inputs(results_of(snakemake), map(Path, snakemake.input))


def seal_job(snakemake: Any) -> None:
    """Seal what the job wrote, as its last step."""
    results = results_of(snakemake)
    outputs = {str(Path(path).relative_to(results)): content_digest(Path(path)) for path in snakemake.output}
    inputs = check_inputs(results, map(Path, snakemake.input))
    made_from = parameters_digest(dict(snakemake.params.items()))
    Seal(snakemake.rule, dict(snakemake.wildcards.items()), made_from, inputs, outputs).write(results)


def parameters_digest(parameters: dict[str, Any]) -> str:
    """Return the digest of the parameters of a rule on which its results depend."""
    return digest({name: value for name, value in parameters.items() if name in MADE_FROM})


def results_of(snakemake: Any) -> Path:
    """Return the folder of the tier whose job this is; logs stand in a folder of it."""
    logs = next(folder for folder in Path(snakemake.log[0]).parents if folder.name == "logs")
    return logs.parent
