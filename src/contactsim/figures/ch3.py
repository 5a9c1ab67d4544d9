"""Chapter 3: contact without adhesion. Each function draws one figure and returns the numbers that it shows.

Values of the thesis, from `reference` in the config, come as keywords.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from contactsim import analytic
from contactsim.aggregate import departure
from contactsim.figures import style
from contactsim.grid import Array

FREE_OF_EDGES = 0.05, 0.25
"""c/R between which a cylinder at L/R = 4 has enough points and does not feel its neighbours."""


def _cylinder(data: xr.Dataset) -> xr.Dataset:
    """The one member, with the exact values and the width of a grid point, as a part of the contact's."""
    one = data.isel(member=0)
    radius = float(one.half_width_exact[0] / one.contact_ratio[0])
    return one.assign(
        resolution=one.length / one.points / (2 * one.half_width_exact),
        width=2 * one.half_width / radius,
        width_exact=2 * one.half_width_exact / radius,
        line_load=one.mean_pressure * one.length / (one.contact_modulus * radius),
        rms_gradient_exact=one.contact_ratio.copy(data=analytic.cylinder_rms_gradient(one.half_width_exact, radius)),
        kappa_r_exact=analytic.CYLINDER_KAPPA_R,
    )


TABLE = {
    "contact_ratio": r"$c/R$",
    "width_exact": "$a_{act}/R$\nexact",
    "width": "$a_{act}/R$\ncomputed",
    "line_load": "$L/(E^*R)$\ngiven",
    "rms_gradient_exact": r"$\bar g_r$" + "\nexact",
    "rms_gradient_contact": r"$\bar g_r$" + "\ncomputed",
    "kappa_r_exact": r"$\kappa_r$" + "\nexact",
    "kappa_r": r"$\kappa_r$" + "\ncomputed",
    "kappa_r_bond": r"$\kappa_r$" + "\nof pairs",
}


def fig_3_1(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """κ_r of the cylinder does not depend on the load (thesis Fig. 3.1, line)."""
    one = _cylinder(data)
    pressure, exact = one.reduced_pressure_contact, analytic.CYLINDER_KAPPA_R
    low, high = float(pressure.min()) / 1.3, float(pressure.max()) * 1.4
    edges = np.interp(FREE_OF_EDGES, one.contact_ratio, pressure)
    for span, x, text in (((low, edges[0]), low, " few points"), ((edges[1], high), edges[1], " neighbours")):
        axes.axvspan(*span, color="#efefef", lw=0, zorder=0)
        axes.text(x, 0.03, text, transform=axes.get_xaxis_transform(), fontsize=7, color="#666666")
    bars = exact * one.resolution
    shown = [
        axes.errorbar(pressure, one.kappa_r, bars, fmt="o", ms=4, color=style.CONTACT, elinewidth=0.7, label="Eq. 3.8"),
        *axes.plot(pressure, one.kappa_r_bond, "+", color=style.PAIRS, ms=6, label="pairs in contact"),
        axes.axhline(exact, color=style.EXACT, lw=1, label=rf"exact, $8/(\pi\sqrt{{3}})={exact:.3f}$"),
    ]
    axes.set(xscale="log", xlim=(low, high))
    style.keep_in_view(axes, exact - 0.2, exact + 0.2)
    axes.set(xlabel=r"reduced pressure $p_r^*$", ylabel=r"$\kappa_r^{1D}$")
    axes.legend(handles=shown, loc="upper right")
    return one[["reduced_pressure_contact", "resolution", *list(TABLE)[1:]]].to_dataframe().reset_index()


def table_3_1(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Cylinder: width, load, gradient in contact and κ_r, exact and computed (thesis Table 3.1, line)."""
    rows = _cylinder(data).to_dataframe().reset_index()[list(TABLE)]
    style.table(axes, list(TABLE.values()), [[f"{value:#.4g}" for value in row] for row in rows.to_numpy()])
    return rows


AVERAGES = ("relative_contact_area", "kappa", "kappa_r", "kappa_r_bond")


def fig_3_2(data: xr.Dataset, axes: list[Axes], *, kappa_r: float) -> pd.DataFrame:
    """Area against both reduced pressures, and the proportionality factors (thesis Fig. 3.2).

    kappa_r: the thesis's constant.
    """
    left, middle, right, last = axes
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value)
        whole, contact = one.reduced_pressure, one.reduced_pressure_contact_mean
        style.with_errors(left, whole, one, "relative_contact_area", color=style.WHOLE, **look)
        style.with_errors(left, contact, one, "relative_contact_area", color=style.CONTACT, **look)
        style.with_errors(middle, whole, one, "kappa", color=style.WHOLE, **look)
        for panel in (middle, right):
            style.with_errors(panel, contact, one, "kappa_r", color=style.CONTACT, **look)
        style.with_errors(right, contact, one, "kappa_r_bond", color=style.PAIRS, **look)
        style.grid_error(last, contact, one, "kappa_r", color=style.CONTACT, **look)
        style.grid_error(last, contact, one, "kappa_r_bond", color=style.PAIRS, **look)
    dense = np.geomspace(*data.reduced_pressure.values[[0, -1]], 100)
    persson = analytic.persson_area(dense)
    left.plot(dense, persson, color=style.EXACT, lw=0.8)
    middle.plot(dense, persson / dense, color=style.EXACT, lw=0.8)
    for panel in (middle, right):
        panel.axhline(kappa_r, color=style.EXACT, lw=0.8, ls=(0, (6, 3)))
    left.set(yscale="log", ylabel=r"relative contact area $a_{\mathrm{rel}}$")
    middle.set(ylabel=r"$\kappa^{1D}$, $\kappa_r^{1D}$")
    right.set(ylabel=r"$\kappa_r^{1D}$")
    style.keep_in_view(right, kappa_r - 0.15, kappa_r + 0.05)
    last.set(yscale="log", ylabel=r"grid error of $\kappa_r^{1D}$")
    for panel, letter in zip(axes, "abcd", strict=True):
        both = panel in (left, middle)
        panel.set(xscale="log", xlabel="reduced pressure " + (r"$p^*$, $p_r^*$" if both else r"$p_r^*$"))
        style.letter(panel, letter)
    left.legend(handles=style.hurst_key(data.hurst.values), loc="upper left")
    colours = {r"$\bar g$ over the whole surface": style.WHOLE, r"$\bar g_r$ over the contact (Eq. 3.8)": style.CONTACT}
    lines = {f"thesis, {kappa_r:g}": (0, (6, 3)), r"Persson (2D), erf$(\sqrt{2}p^*)$": "-"}
    middle.legend(
        handles=style.key(colours | {r"$\bar g_r$ over pairs in contact": style.PAIRS}, lines), loc="upper right"
    )
    middle.set_ylim(top=middle.get_ylim()[1] * 1.25)
    right.text(0.03, 0.03, _constancy(data), transform=right.transAxes, fontsize=6, va="bottom")
    return style.averages(data, AVERAGES)


def _constancy(data: xr.Dataset) -> str:
    """The most significant changes of κ_r with pressure and with the Hurst exponent, in words."""
    if data.member.size < 2:
        return ""
    lines = []
    for along, text, other in (("reduced_pressure", "$p^*$", "$H$"), ("hurst", "$H$", "$p^*$")):
        found = departure(data, "kappa_r", along)
        first, second = (place[along] for place in found.places)
        (at,) = (value for name, value in found.places[0].items() if name != along)
        lines.append(rf"{text} from {first:g} to {second:g} at {other} = {at:g}: $\kappa_r$ changes")
        lines.append(f"    by {found.difference:.3f}, {found.in_errors:.1f} standard errors")
    return "\n".join(lines)


FIT_LOOKS = {"area": {"lw": 1.6, "alpha": 1.0}, "logarithm": {"lw": 0.8, "alpha": 0.6}}
"""Lines of a fit by how it weighs."""


def fig_3_3(data: xr.Dataset, axes: Axes) -> pd.DataFrame:
    """Eq. 3.11 fitted to each Hurst exponent and to all (thesis Fig. 3.3).

    Returns the constants of every fit, and κ of it at each load of the data.
    """
    dense = np.geomspace(*data.reduced_pressure.values[[0, -1]], 200)
    lowest = data.sel(fit_limit=float(data.fit_limit.min()))
    for weighting in FIT_LOOKS:
        for name in data.fitted.values:
            fit = lowest.sel(weighting=weighting, fitted=name)
            axes.plot(dense, _kappa_fit(dense, fit.fit_b1.item(), fit.fit_b2.item()), **_fit_look(name, weighting))
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value) | {"linestyle": "none"}
        style.with_errors(axes, one.reduced_pressure, one, "kappa", color="#888888", **look)
    axes.plot(dense, analytic.persson_area(dense) / dense, color=style.EXACT, lw=0.8, ls="-.")
    axes.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}_{\mathrm{fit}}$")
    axes.set_ylim(top=axes.get_ylim()[1] * 1.22)
    lines = {"fit to all $H$, of the area": ("all", "area"), "of its logarithm": ("all", "logarithm")}
    lines |= {"fit to one $H$, of the area": ("one", "area"), "of its logarithm ": ("one", "logarithm")}
    keys = [Line2D([], [], label=label, **_fit_look(*fit)) for label, fit in lines.items()]
    last = style.key({}, {"Persson (2D)": "-."})
    axes.legend(handles=style.hurst_key(data.hurst.values) + last + keys, ncols=2, loc="upper right")
    names = [name for name in data.data_vars if str(name).startswith("fit_")]
    fitted = data[names].assign(kappa_fit=xr.apply_ufunc(_kappa_fit, data.reduced_pressure, data.fit_b1, data.fit_b2))
    order = [*data.fit_b1.dims, "reduced_pressure"]
    return fitted.to_dataframe(dim_order=order).reset_index()


def _fit_look(name: str, weighting: str) -> dict[str, object]:
    """The fit to all is broad and lies below those to one Hurst exponent, so that both are seen where they meet."""
    look = FIT_LOOKS[weighting]
    if name == "all":
        return {"color": style.PAIRS, "lw": 2.5 * look["lw"], "alpha": 0.5 * look["alpha"], "zorder": 1.5}
    line = "-" if name == "one" else style.hurst(float(name))["linestyle"]
    return look | {"color": style.WHOLE, "ls": line}


def _kappa_fit(pressure: Array, b1: Array, b2: Array) -> Array:
    """κ = a_rel/p* by Eq. 3.11; the arrays broadcast."""
    return analytic.line_area(pressure, b1, b2) / pressure
