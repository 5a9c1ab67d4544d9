"""A law by itself: its tractions against the gap, as a dataset to be drawn; nothing is simulated."""

from __future__ import annotations

import numpy as np
import xarray as xr

from contactsim import dataset
from contactsim.code_digest import source_digest
from contactsim.errors import InputError
from contactsim.interface.base import Law
from contactsim.interface.registry import EFFECTS
from contactsim.study.reading import Key, choice, keys_of, listed, number, positive, read

MIXED = tuple(name for name, law in EFFECTS.items() if {"n", "t"} <= law.reads)
CURVE_POINTS = 601
"""Points of each curve."""

LAW_KEYS = {
    "effect": Key(choice(MIXED), f"one of {', '.join(MIXED)}"),
    "normal_gap": Key(listed(number), "a list of normal gaps, nm, at which the tangential traction is drawn"),
    "tangential_gap": Key(listed(number), "a list of tangential gaps, nm, at which the normal traction is drawn"),
    "reach": Key(positive, "the largest gap drawn, nm"),
}


def read_law(section: dict, file: object, prefix: str) -> dict:
    """Return the settings of a law that is tabulated: those above, and its own options."""
    effect = read({"effect": section.get("effect")}, {"effect": LAW_KEYS["effect"]}, file, prefix)["effect"]
    settings = read(section, {**LAW_KEYS, **keys_of(EFFECTS[effect])}, file, prefix)
    try:
        law = _law(settings)
    except InputError as error:
        raise error.located(file, prefix) from error
    if law.exerts != law.reads:
        raise InputError(prefix, section, "options with which it exerts both tractions", file)
    return settings


def tabulate_law(settings: dict) -> xr.Dataset:
    """Return the tractions (GPa) of a law: normal (tangential_gap, opening), tangential (normal_gap, slip); gaps in nm.

    settings: as `read_law` returns them. The opening goes from -1 nm up to the reach, the slip over both signs of it.
    """
    law, reach = _law(settings), settings["reach"]
    opening, slip = np.linspace(-1.0, reach, CURVE_POINTS), np.linspace(-reach, reach, CURVE_POINTS)
    normal = [law.traction(np.stack((opening, np.full(CURVE_POINTS, at))))[0] for at in settings["tangential_gap"]]
    tangential = [law.traction(np.stack((np.full(CURVE_POINTS, at), slip)))[1] for at in settings["normal_gap"]]
    data = xr.Dataset(
        {
            "normal_traction": (("tangential_gap", "opening"), normal),
            "tangential_traction": (("normal_gap", "slip_gap"), tangential),
        },
        {
            "opening": opening,
            "slip_gap": slip,
            "normal_gap": settings["normal_gap"],
            "tangential_gap": settings["tangential_gap"],
        },
    )
    title = f"contactsim table of {settings['effect']}"
    return dataset.stamp(dataset.describe(data), title, settings, source_digest("contactsim.study.law_table"))


def _law(settings: dict) -> Law:
    """Return the law with its options."""
    return EFFECTS[settings["effect"]](**{name: settings[name] for name in keys_of(EFFECTS[settings["effect"]])})
