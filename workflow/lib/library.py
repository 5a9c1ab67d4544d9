"""Where the workflow's own modules are found."""

from __future__ import annotations

import os
from pathlib import Path


def share_library() -> None:
    """Let the scripts of jobs import from the folder of this file; they inherit the environment of this process."""
    folder = str(Path(__file__).parent)
    paths = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    if folder not in paths:
        os.environ["PYTHONPATH"] = os.pathsep.join([folder, *filter(None, paths)])
