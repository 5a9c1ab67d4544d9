"""Where a job's words go: everything it logs, warns or dies of, into its log file."""

from __future__ import annotations

import logging
import sys


def logged(path: str) -> None:
    """Send log lines, warnings and tracebacks of this process to a file, as they come."""
    stream = open(path, "w", buffering=1, encoding="utf-8")  # noqa: SIM115 - stays open for the life of the job
    sys.stdout = sys.stderr = stream
    logging.basicConfig(stream=stream, level="INFO", format="%(asctime)s %(levelname)s %(message)s")
    logging.getLogger("fontTools").setLevel("WARNING")
    logging.captureWarnings(True)
