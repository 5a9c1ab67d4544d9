"""`contactsim explain | run | estimate | compare`: one scene from the shell; two tiers side by side.

A scene file has the keys of a study (config/README.md) without `vary`, `members`, `coarse_grid`, `tight_tolerance`,
`full_model` and `fit_limits`, and may give `seed`. In place of a file, `explain` and `estimate` take the name of a
study in ./config; without either, `estimate` is for every figure there. `compare` reads the CSV files of the figures in
./config, as they lie in its results folder.
"""

from __future__ import annotations

import argparse
import logging
import sys
from importlib import import_module

from contactsim.errors import InputError


def main(arguments: list[str] | None = None) -> None:
    """Read the command line and call the command; what it needs is imported only then."""
    parser = argparse.ArgumentParser(prog="contactsim", description="One scene, or two tiers, from the shell.")
    commands = parser.add_subparsers(required=True)
    telling = commands.add_parser("explain", help="which effects are on, what exists, what it costs")
    telling.add_argument("scene", help="a scene file, or the name of a study in ./config")
    telling.add_argument("--tier", help="tier of the study")
    telling.add_argument("--draw", metavar="FILE", help="draw the scene into a .png, .pdf or .svg")
    telling.set_defaults(command="explain_scene")
    running = commands.add_parser("run", help="simulate it")
    running.add_argument("scene", help="a scene file")
    running.add_argument("--output", metavar="FILE", help="dataset to write, default beside the scene file")
    threads = "of the transforms, default 1; results are the same bit for bit at one number of threads"
    running.add_argument("--threads", type=int, default=1, help=threads)
    running.set_defaults(command="run_scene")
    costing = commands.add_parser("estimate", help="expected cost and error, before anything runs")
    costing.add_argument("scene", nargs="?", help="a scene file, or a study in ./config; without it, all figures")
    costing.add_argument("--tier", help="tier of the study or figures")
    costing.add_argument("--accuracy", type=float, help="relative error for which grid and increments are chosen")
    costing.set_defaults(command="estimate_cost")
    comparing = commands.add_parser("compare", help="how far the figures of two tiers differ")
    comparing.add_argument("first", help="a tier, such as quick")
    comparing.add_argument("second", help="the tier that differences are relative to")
    comparing.add_argument("--within", type=float, default=0.1, help="largest relative difference, default 0.1")
    comparing.set_defaults(command="compare_tiers")
    options = parser.parse_args(arguments)
    logging.basicConfig(level="INFO", format="%(message)s", stream=sys.stderr)
    try:
        getattr(import_module("contactsim.commands"), options.command)(options)
    except InputError as error:
        sys.exit(f"Error: {error}")
    except OSError as error:
        sys.exit(f"Error: {error.filename}: {error.strerror}")
