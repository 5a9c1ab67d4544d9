"""The command line: `contactsim new | explain | run | press | estimate | compare | schema | verify`.

A scene file has the keys of a study (config/README.md) without `vary`, `members`, `coarse_grid`, `tight_tolerance`,
`full_model` and `fit_limits`, and may give `seed`. `new` writes one to begin with. `--set` changes its keys for one
command. In place of a file, `explain`, `run` and `estimate` take the name of a study in ./config; without either,
`estimate` predicts every figure there. `press` takes a file of measured heights.
`compare` reads the CSV files of the figures in the results folder of ./config. `verify` reads every result there, or in
the folder of a tier.
"""

from __future__ import annotations

import argparse
import logging
import sys
from importlib import import_module
from typing import Any

import contactsim
from contactsim.errors import InputError


def main(arguments: list[str] | None = None) -> None:
    """Read the command line and call the command; what it needs is imported only then."""
    parser = argparse.ArgumentParser(
        prog="contactsim",
        description="Explain or simulate a scene, press measured heights, estimate costs, compare or verify results.",
    )
    parser.set_defaults(module="commands")
    parser.add_argument("--version", action="version", version=f"contactsim {contactsim.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    _add_scene_commands(commands)
    _add_press(_add_command(commands, "press", "press measured heights on a half-space or layer"))
    _add_result_commands(commands)
    options = parser.parse_args(arguments)
    logging.basicConfig(level="INFO", format="%(message)s", stream=sys.stderr)
    try:
        getattr(import_module(f"contactsim.{options.module}"), options.command)(options)
    except InputError as error:
        as_typed = import_module("contactsim.study.as_typed").as_typed
        sys.exit(f"Error: {as_typed(error)}")
    except OSError as error:
        sys.exit(f"Error: {error.filename}: {error.strerror}")


def _add_command(commands: Any, name: str, text: str) -> argparse.ArgumentParser:
    """Add a command; the text stands in the list of commands and in its own help."""
    return commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")


def _add_scene_commands(commands: Any) -> None:
    """Add the commands about a scene; commands: the place for them of argparse."""
    new = _add_command(commands, "new", "write a scene file to begin with")
    new.add_argument("kind", nargs="?", help="kind of scene; without it all kinds are listed")
    new.add_argument("--output", metavar="FILE", help="file to write, default KIND.yaml")
    new.set_defaults(module="scene_files", command="write_new_scene")
    explain = _add_command(commands, "explain", "show effects, fields, cost and solvers of a scene")
    explain.add_argument("scene", help="a scene file, or a study in ./config")
    explain.add_argument("--tier", help="tier of the study, default that of ./config")
    explain.add_argument("--draw", metavar="FILE", help="draw the scene into this .png, .pdf or .svg file")
    _add_set(explain)
    explain.set_defaults(command="explain_scene")
    run = _add_command(commands, "run", "simulate a scene")
    run.add_argument("scene", help="a scene file, or a study of one run in ./config")
    run.add_argument("--tier", help="tier of the study, default that of ./config")
    run.add_argument("--output", metavar="FILE", help="dataset to write, default the name of the scene with .nc")
    _add_set(run)
    threads = (
        "threads of the Fourier transforms, default 1; results are reproducible bit for bit with one number of threads"
    )
    run.add_argument("--threads", type=int, default=1, help=threads)
    run.set_defaults(command="run_scene")
    estimate = _add_command(commands, "estimate", "predict cost and error without simulating")
    estimate.add_argument("scene", nargs="?", help="a scene file, or a study in ./config; default all figures")
    estimate.add_argument("--tier", help="tier of the study or figures, default that of ./config")
    estimate.add_argument(
        "--accuracy", type=float, help="relative error from which grid, tolerance and increments follow"
    )
    _add_set(estimate)
    estimate.set_defaults(command="estimate_cost")


def _add_result_commands(commands: Any) -> None:
    """Add the commands about results of the workflow; commands: the place for them of argparse."""
    compare = _add_command(commands, "compare", "compare the figures of two tiers, or of results that were kept")
    compare.add_argument("first", help="a tier, such as quick, or a folder with the results of one")
    compare.add_argument("second", help="the one to which differences are relative, a tier or a folder")
    compare.add_argument(
        "--within", type=float, default=0.1, help="largest relative difference that passes, default 0.1"
    )
    compare.set_defaults(command="compare_tiers")
    schema = _add_command(commands, "schema", "print the JSON Schema of a chapter's settings, for editors")
    schema.set_defaults(command="print_schema")
    verify = _add_command(
        commands, "verify", "check all results of a tier, and list those that were damaged or replaced"
    )
    verify.add_argument("folder", nargs="?", help="a folder such as results/standard, default that of ./config")
    verify.set_defaults(command="verify_results")


def _add_set(command: argparse.ArgumentParser) -> None:
    """Add the option that changes keys of a scene file."""
    text = "change a key of the scene file for this command, as in --set surface.hurst_exponent=0.5; may be repeated"
    command.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], dest="changes", help=text)


def _add_press(press: argparse.ArgumentParser) -> None:
    """Add the options of `contactsim press`."""
    press.add_argument(
        "file", help="heights along a line or over an area: npy, npz, mat, csv, txt, xyz, dat, asc, nc, others"
    )
    _add_scan(press.add_argument_group("scan"))
    _add_bodies(press.add_argument_group("bodies and pressure"))
    results = press.add_argument_group("results")
    results.add_argument("--figure", metavar="FILE", help="draw the numbers with their errors: .png, .pdf or .svg")
    results.add_argument("--output", metavar="FILE", help="dataset to write, .nc")
    press.set_defaults(module="press_command", command="press_file")


def _add_scan(scan: Any) -> None:
    """Add the options on how a file is read and prepared; scan: their group."""
    scan.add_argument(
        "--spacing", type=float, nargs="+", metavar="D", help="distance of points, nm; two values: along y and x"
    )
    scan.add_argument("--unit", help="unit of lengths to which the file gives none, such as um")
    scan.add_argument("--variable", help="name of the heights in the file")
    scan.add_argument("--delimiter", help="separator in a text: a comma, a semicolon, a tab or a blank")
    scan.add_argument("--fill", help="how missing points are filled: linear, nearest or lowest")
    scan.add_argument(
        "--detrend", help="what is subtracted: none, mean, linear (default of a line), plane (of an area) or quadratic"
    )
    scan.add_argument("--level", default="none", help="how scan lines are levelled: none, median or steps")
    scan.add_argument("--spikes", type=float, metavar="N", help="standard deviations beyond which a point is replaced")
    scan.add_argument("--ends", default="none", help="make the heights repeat: mirror, window, or tilt on a line")
    periodic = "press the heights as if they repeated as they are, not alone on the half-space"
    scan.add_argument("--periodic", action="store_true", help=periodic)
    other = "scan of the other body, seen from outside it; it is mirrored along x and pressed on"
    scan.add_argument("--other", metavar="FILE", help=other)
    scan.add_argument("--other-unit", metavar="UNIT", help="the same as --unit for the other scan, default --unit")
    offset = "points by which the other scan is moved, along x or along y and x"
    scan.add_argument("--offset", type=int, nargs="+", metavar="N", help=offset)


def _add_bodies(bodies: Any) -> None:
    """Add the options on bodies and pressures; bodies: their group."""
    modulus = "E* of the pair of bodies, GPa"
    bodies.add_argument("--contact-modulus", type=float, required=True, metavar="E*", help=modulus)
    pressure = "mean pressures over the length or area, GPa"
    bodies.add_argument("--mean-pressure", type=float, nargs="+", required=True, metavar="P", help=pressure)
    thickness = "thickness of a layer on a rigid base, nm; without it a half-space"
    bodies.add_argument("--thickness", type=float, metavar="H", help=thickness)
    bodies.add_argument("--poisson-ratio", type=float, metavar="NU", help="Poisson's ratio of the layer")
    conductivities = "thermal conductivities of both bodies, W/(m K), for the thermal conductance"
    bodies.add_argument("--conductivities", type=float, nargs=2, metavar="C", help=conductivities)
    hardness = "hardness, GPa, for the share of the contact above it"
    bodies.add_argument("--hardness", type=float, metavar="H", help=hardness)
