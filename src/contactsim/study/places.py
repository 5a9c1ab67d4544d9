"""Files and folders that settings name: those of the config itself, that of the results, and measured heights."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from contactsim.errors import InputError
from contactsim.study.plain_yaml import READABLE

CODE_FOLDERS = ("benchmarks", "config", "docs", "examples", "profiles", "src", "tests", "workflow")
"""Folders of a project that hold no results; nor do those whose names begin with a dot."""
CHAPTER = re.compile(r"ch\d+")
"""Name of the file of a chapter."""
FOLDER_NAME = re.compile(r"[\w ./@%+=,-]+")
"""Form of the folder of the results: other signs mean something to Snakemake or to a shell."""


def check_config_files(folder: Path, names: Iterable[str]) -> None:
    """Raise InputError for a config without a folder, and for settings in it that nothing would read.

    names: of the files beside the chapters, without ending
    """
    if not folder.is_dir():
        raise InputError("config", folder, f"a folder with {', '.join(names)} and chapters", folder)
    for file in sorted(folder.iterdir()):
        if file.suffix.lower() not in (".yaml", ".yml") or file.name.startswith("."):
            continue
        if file.suffix != ".yaml" or not (file.stem in names or CHAPTER.fullmatch(file.stem)):
            allowed = f"ch1.yaml, ch2.yaml … for chapters, and {', '.join(f'{name}.yaml' for name in names)}"
            raise InputError("file", file.name, allowed, file)
        if not file.is_file():
            raise InputError("file", file, READABLE, file)


def read_results(text: str, tier: str, project: Path, file: Path) -> Path:
    """Return the folder of a tier's results; InputError for one that cannot be made, or that is among the code.

    Parameters
    ----------
    text
        Folder of all results.
    tier
        Name of the tier.
    project
        Folder of the project.
    file
        File of the setting, for messages.
    """
    if not FOLDER_NAME.fullmatch(text) or any(part != part.strip() for part in text.split("/")):
        allowed = "a folder for all results, in letters, digits, single blanks within and the signs . / _ - @ % + = ,"
        raise InputError("results", text, allowed, file)
    results = Path(text) / tier
    place, home = Path(os.path.abspath(results)), Path(os.path.abspath(project))
    parts = place.relative_to(home).parts if home in place.parents else ()
    if place in (home, *home.parents) or (parts and (parts[0] in CODE_FOLDERS or parts[0].startswith("."))):
        raise InputError("results", text, f"a folder for all results, none of {', '.join(CODE_FOLDERS)}", file)
    try:
        parent = next(folder for folder in (place, *place.parents) if os.path.lexists(folder))
        is_usable = parent.is_dir() and os.access(parent, os.W_OK | os.X_OK) and not _has_long_name(place)
    except OSError:
        is_usable = False
    if not is_usable:
        raise InputError("results", text, f"a folder that can be made and written to, as {place}", file)
    return results


def _has_long_name(place: Path) -> bool:
    """Return True where a part of a path is longer than names of files may be."""
    return any(len(os.fsencode(part)) > 255 for part in place.parts)


def data_file(path: str, folders: Sequence[str]) -> Path:
    """Return the place of a file of measured heights; ValueError for one outside of the folders that may be read.

    folders: beside the one in which the command is given, which holds the project
    """
    place = Path(path).resolve()
    if not any(place.is_relative_to(Path(folder).resolve()) for folder in (".", *folders)):
        raise ValueError("outside of this folder; `data_folders` of config.yaml names others")
    return place
