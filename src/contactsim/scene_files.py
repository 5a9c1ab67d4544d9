"""Scene files: how they are read, changed for one command, and written to begin with."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import yaml

from contactsim.errors import InputError
from contactsim.study.keys import ERROR_RUNS
from contactsim.study.plain_yaml import SettingsLoader, load_yaml
from contactsim.study.plan import Plan
from contactsim.study.reading import whole
from contactsim.study.study import Study

TEMPLATES = Path(__file__).with_name("templates")
"""Scene files to begin with."""


def read_scene(path: str, changes: Sequence[str] = (), accuracy: float | None = None) -> Study:
    """Return the one-run study in a scene file.

    Parameters
    ----------
    path
        The scene file.
    changes
        Values in place of those in the file, each as KEY=VALUE.
    accuracy
        Relative error that counts where the file has neither an accuracy nor a tolerance.
    """
    section = load_yaml(path)
    for change in changes:
        _apply_change(section, change)
    if accuracy is not None and not {"accuracy", "tolerance"} & set(section):
        section["accuracy"] = accuracy
    for key in ("vary", "members", *ERROR_RUNS, "fit_limits", "same_surfaces_as", "snapshot_members"):
        if key in section:
            raise InputError(key, section[key], "left out: a scene file is one run, this belongs to studies", path)
    seed = section.pop("seed", 0)
    try:
        whole(0)(seed)
    except ValueError as error:
        raise InputError("seed", seed, "a whole number, 0 or more", path) from error
    name = Path(path).stem
    try:
        return Study.read(name, {"title": name} | section, path, seed)
    except InputError as error:  # in a scene file the keys stand at the top
        raise error.renamed(f"studies.{name}.", "") from error


def _apply_change(section: dict[str, Any], change: str) -> None:
    """Put a value in place of one in a scene file; change: KEY=VALUE, the key with dots, the value as in YAML."""
    key, equals, text = change.partition("=")
    *places, name = key.split(".")
    if not (equals and name):
        raise InputError("--set", change, "KEY=VALUE, as in surface.hurst_exponent=0.5")
    for place in places:
        section = section.setdefault(place, {})
        if not isinstance(section, dict):
            raise InputError("--set", change, f"a key below a mapping; {place!r} is none")
    try:
        section[name] = yaml.load(text, SettingsLoader)
    except yaml.YAMLError as error:
        raise InputError("--set", change, "a value in plain YAML after the sign =") from error


def find_study(scene: str, tier: str | None, changes: Sequence[str] = (), accuracy: float | None = None) -> Study:
    """Return a study, from a scene file or by its name in ./config; changes, accuracy: see `read_scene`."""
    if accuracy is not None and not 0 < accuracy < 1:
        raise InputError("--accuracy", accuracy, "a relative error, above 0 and below 1")
    if Path(scene).suffix:
        if tier is not None:
            raise InputError("--tier", tier, "none with a scene file: tiers belong to studies")
        return read_scene(scene, changes, accuracy)
    if changes:
        raise InputError("--set", changes[0], "none with a study: change it in ./config")
    if not Path("config").is_dir():
        raise InputError("scene", scene, "a scene file, or a study's name where there is a folder config")
    studies = Plan.read("config", tier).studies
    if scene not in studies:
        raise InputError("scene", scene, f"a .yaml file or one of {', '.join(studies)}")
    return studies[scene]


def write_new_scene(options: argparse.Namespace) -> None:
    """Write a scene file to begin with, or list the kinds; a file that exists is not replaced."""
    templates = {file.stem: file for file in sorted(TEMPLATES.glob("*.yaml"))}
    heads = {name: file.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ") for name, file in templates.items()}
    if options.kind is None:
        sys.stdout.write("".join(f"{name:20} {head}\n" for name, head in heads.items()))
        return
    if options.kind not in templates:
        raise InputError("kind", options.kind, f"one of {', '.join(templates)}")
    target = Path(options.output or f"{options.kind}.yaml")
    if target.exists():
        raise InputError("--output", str(target), "the name of a file that does not exist yet")
    target.write_text(templates[options.kind].read_text(encoding="utf-8"), encoding="utf-8")
    sys.stdout.write(f"written to {target}; next: contactsim explain {target}, contactsim run {target}\n")
