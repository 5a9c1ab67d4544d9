"""Slides as tables: force, load and contact against the sliding distance, their stages, and the exact answer of flats.

As in the thesis, forces are over the period and a modulus of 70 GPa, lengths over the period (Chapter 6).
"""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from contactsim.analysis.ensemble import converged
from contactsim.analysis.scales import LawScales, body_settings, critical_modulus_ratio, lattice_constant, radius
from contactsim.grid import Array
from contactsim.observables.slide_peeling import SHRINKING
from contactsim.reference import adhesion, springs

MODULUS, FIRST_APPROACH = 70.0, 10.0
"""Young's modulus (GPa) that forces are given over, and δ0 (nm) that approaches are given over."""
ROUNDING = 1e-9
"""Difference of sliding distances, nm, that counts as none."""
FORCES = {"force": "friction_force", "load": "line_load"}
LENGTHS = {"area": "contact_length", "trailing": "contact_trailing_edge", "leading": "contact_leading_edge"}
"""Variables of a dataset by the columns of a slide's table."""


def slide_table(data: xr.Dataset) -> pd.DataFrame:
    """Return the states of a slide.

    Parameters
    ----------
    data : one member of one variant

    Returns
    -------
    table : slide (nm), relative_slide, force, load, area, and the trailing and leading edges of the contact; NaN where
        a state did not converge
    """
    states = data.isel(step=np.flatnonzero(np.isfinite(data.sliding_distance.values)))
    period = float(data.length)
    table = {"slide": states.sliding_distance.values, "relative_slide": states.sliding_distance.values / period}
    table |= {name: converged(states[key], states).values / period / MODULUS for name, key in FORCES.items()}
    table |= {name: converged(states[key], states).values / period for name, key in LENGTHS.items()}
    return pd.DataFrame(table)


def stages(data: xr.Dataset, table: pd.DataFrame) -> list[int]:
    """Return the states A to E of a slide: before it, peeling (B, C), before the first slip, and after it.

    data, table: of `slide_table`
    """
    slips = data.event_sliding_distance.dropna("event").values
    after = int(np.searchsorted(table.slide.values, slips[0] - ROUNDING)) if slips.size else len(table) - 1
    before = after - 1
    lost = table.area.values[0] - table.area.values[:after]
    peeling = [int(np.argmin(np.abs(lost - share * lost[-1]))) for share in SHRINKING.values()]
    return [0, *peeling, before, after]


def exact_flat_force(data: xr.Dataset, slides: Array, sine: bool = False) -> Array:
    """Return the force of a flat against its sliding distance, with one degree of freedom.

    data: of one variant; slides: nm; the force is over the period and `MODULUS`; sine: by Prandtl and Tomlinson's model
    """
    law, body = LawScales.of(data), body_settings(data, "counter_body")
    modulus = float(data.counter_body_youngs_modulus)
    stiffness = modulus / (2 * (1 + body["poisson_ratio"])) / body["thickness"]
    length = law.tangential_length
    strength = law.work_of_separation * float(data.work_ratio) / length
    return springs.uniform_slide(slides, stiffness, strength, lattice_constant(data), length, sine) / MODULUS


def friction_against_modulus(data: xr.Dataset) -> pd.DataFrame:
    """Return the mean friction of flats against the modulus over the strength.

    Columns: modulus_over_strength, mean_friction (Eq. 6.7), average_friction (over whole periods), their increment
    errors, relative_friction (the first over period and strength), slip_count, thickness (nm), and critical: modulus
    over strength above which sliding is smooth. The study varies the modulus or the ratio of works.
    """
    member, law, body = data.isel(member=0), LawScales.of(data), body_settings(data, "counter_body")
    ratio = member.work_ratio.values if "work_ratio" in member.dims else law.work_ratio
    modulus = (
        member.counter_body_youngs_modulus.values
        if "counter_body_youngs_modulus" in member.dims
        else body["youngs_modulus"]
    )
    strength = adhesion.tangential_strength(law.work_of_separation * ratio, law.tangential_length, 0.0)
    table = {
        "modulus_over_strength": modulus / strength,
        "relative_friction": member.mean_friction.values / (float(member.length) * strength),
    }
    scale = 1 / (float(member.length) * MODULUS)
    names = ("mean_friction", "average_friction")
    table |= {name: scale * member[name].values for name in names}
    table |= {
        "slip_count": member.slip_count.values,
        "thickness": body["thickness"],
        "critical": critical_modulus_ratio(data),
    }
    table |= {f"{name}_increment_error": scale * member[f"{name}_increment_error"].values for name in names}
    return pd.DataFrame(table)


def friction_by_prandtl_tomlinson(data: xr.Dataset, ratios: Array) -> Array:
    """Return Eq. 6.7 over period and strength at moduli over strength, of a sine as high as the sum of the springs."""
    law, body, lattice = LawScales.of(data), body_settings(data, "counter_body"), lattice_constant(data)
    strength = adhesion.tangential_strength(1.0, law.tangential_length, 0.0)
    means = []
    for ratio in ratios:
        stiffness = ratio * strength / (2 * (1 + body["poisson_ratio"])) / body["thickness"]
        onset = strength / stiffness + lattice
        slides = np.linspace(0.0, onset + 3 * lattice, 1501)
        force = springs.uniform_slide(slides, stiffness, 1 / law.tangential_length, lattice, sine=True)
        end = force[slides >= onset]
        means.append((end.max() + end.min()) / 2 / strength)
    return np.array(means)


def contact_to_onset(data: xr.Dataset) -> pd.DataFrame:
    """Return force and contact of a slide up to the onset, and what two laws make of it.

    `fit`: the contact by Eq. 6.8, A0 - ζF²; `crack`: that of a crack of both modes on a half-space, at the load of each
    state (`adhesion.sheared_half_width`).
    """
    period, body = float(data.length), body_settings(data, "counter_body")
    table = slide_table(data)
    table = table[table.slide <= float(data.onset_sliding_distance) + ROUNDING][["force", "area", "load"]]
    force, load = (table[name].values * period * MODULUS for name in ("force", "load"))
    fit = (float(data.initial_contact_length) - float(data.quadratic_coefficient) * force**2) / period
    contact_modulus = body["youngs_modulus"] / (1 - body["poisson_ratio"] ** 2)
    work = LawScales.of(data).work_of_separation
    half_width = adhesion.sheared_half_width(load, force, work, radius(data), contact_modulus)
    return table.drop(columns="load").assign(fit=fit, crack=2 * half_width / period)


def onset_table(data: xr.Dataset) -> pd.DataFrame:
    """Return force and contact at the onset at each approach, with shear strength and offset of Eq. 6.9.

    Columns: force, area, approach (nm), shear_strength (over `MODULUS`) and offset (a reduced force).
    """
    member, period = data.isel(member=0), float(data.length.max())
    scale = 1 / (period * MODULUS)
    table = pd.DataFrame(
        {
            "force": (member.static_friction * scale).values,
            "area": (member.onset_contact_length / period).values,
            "approach": member.slide_approach.values,
        }
    )
    strength, offset = float(member.shear_strength), float(member.friction_without_contact)
    return table.assign(shear_strength=strength / MODULUS, offset=offset * scale)


def node_positions(data: xr.Dataset) -> tuple[Array, Array]:
    """Return positions from the highest point over the period, ascending, and the nodes that they belong to."""
    count = data.x.size
    nodes = (np.arange(count) + count // 2 + int(np.argmax(data.heights.values))) % count
    return (np.arange(count) - count // 2) / count, nodes
