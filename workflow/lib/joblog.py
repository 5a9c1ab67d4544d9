"""The log file of a job: all that it logs, warns of or fails with."""

from __future__ import annotations

import logging
import sys


def open_log(path: str) -> None:
    """Send log lines, warnings and tracebacks of this process to a file as they come."""
    stream = open(path, "w", buffering=1, encoding="utf-8")  # noqa: SIM115 - stays open for the life of the job
    sys.stdout = sys.stderr = stream
    logging.basicConfig(stream=stream, level="INFO", format="%(asctime)s %(levelname)s %(message)s")
    logging.getLogger("fontTools").setLevel("WARNING")
    logging.captureWarnings(True)
