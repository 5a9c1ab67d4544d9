"""A lock that keeps two Snakemakes in one folder apart."""

from __future__ import annotations

import fcntl
import sys
from pathlib import Path
from typing import TextIO


def lock_folder(folder: Path) -> TextIO:
    """Return a lock on a folder, held as long as the returned file is open; exit where another process holds it.

    The system releases it when the process ends, so a kill leaves no lock behind.
    """
    folder.mkdir(exist_ok=True)
    file = (folder / "one-at-a-time").open("w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit("Error: another snakemake is at work in this folder; wait for it or stop it")
    return file
