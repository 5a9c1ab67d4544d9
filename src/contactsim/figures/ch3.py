"""Chapter 3: contact without adhesion."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from contactsim import analytic
from contactsim.figures import style


def fig_3_1(data: xr.Dataset, axes: Axes, reference: Mapping[str, float]) -> None:
    """κ_r of the cylinder does not depend on the load (thesis Fig. 3.1, line)."""
    one = data.isel(member=0)
    pressure = one.reduced_pressure_contact
    axes.semilogx(pressure, one.kappa_r, "o", color=style.CONTACT, markersize=4, label="Eq. 3.8, as in the thesis")
    axes.semilogx(pressure, one.kappa_r_bond, "+", color=style.PAIRS, markersize=6, label="pairs in contact")
    exact = analytic.CYLINDER_KAPPA_R
    axes.axhline(exact, color=style.EXACT, lw=1, label=rf"exact, $8/(\pi\sqrt{{3}})={exact:.3f}$ (Eq. 3.7)")
    for ratio, where, text in ((0.05, "right", "grid matters"), (0.25, "left", "neighbours matter")):
        edge = float(np.interp(ratio, one.contact_ratio, pressure))
        axes.axvspan(*((0, edge) if where == "right" else (edge, 1)), color="#eeeeee", lw=0, zorder=0)
        axes.annotate(
            text,
            (edge, 0.04),
            (4 if where == "left" else -4, 0),
            ha=where,
            textcoords="offset points",
            xycoords=("data", "axes fraction"),
            fontsize=7,
            color="#666666",
        )
    low, high = float(pressure.min()), float(pressure.max())
    axes.set(
        xlim=(low / 1.3, high * 1.3),
        ylim=(exact - 0.2, exact + 0.2),
        xlabel=r"reduced pressure $p_r^*$",
        ylabel=r"$\kappa_r$",
    )
    axes.legend()


def table_3_1(data: xr.Dataset, axes: Axes, reference: Mapping[str, float]) -> None:
    """Cylinder: half-width, load, gradient in contact and κ_r, exact and computed (thesis Table 3.1, line)."""
    settings = float(data.length), float(data.contact_modulus)
    ratios = data.contact_ratio.values
    inside = (ratios >= 0.05) & (ratios <= 0.25)
    one = data.isel(member=0, contact_ratio=inside)
    radius = float(one.half_width_exact[0] / one.contact_ratio[0])
    rows = []
    for here in (one.isel(contact_ratio=k) for k in range(one.contact_ratio.size)):
        width, load = float(here.half_width_exact), float(here.mean_pressure) * settings[0]
        rows.append(
            [
                f"{float(here.contact_ratio):g}",
                f"{2 * width / radius:.4f}",
                f"{float(2 * here.half_width) / radius:.4f}",
                f"{load / (settings[1] * radius):.5f}",
                f"{analytic.cylinder_rms_gradient(width, radius):.5f}",
                f"{float(here.rms_gradient_contact):.5f}",
                f"{analytic.CYLINDER_KAPPA_R:.4f}",
                f"{float(here.kappa_r):.4f}",
                f"{float(here.kappa_r_bond):.4f}",
            ]
        )
    heads = [
        "c/R",
        "$a_{act}/R$\nexact",
        "computed",
        "$L/(E^*R)$\ngiven",
        r"$\bar g_r$" + "\nexact",
        "computed",
        r"$\kappa_r$" + "\nexact",
        "computed\n(Eq. 3.8)",
        "computed\n(pairs)",
    ]
    axes.axis("off")
    table = axes.table(rows, colLabels=heads, loc="center", cellLoc="center")
    table.auto_set_font_size(False)
    table.set_fontsize(7.5)
    table.scale(1, 1.25)
    for (row, _), cell in table.get_celld().items():
        cell.set(edgecolor="#bbbbbb", height=cell.get_height() * (1.8 if row == 0 else 1))


def fig_3_2(data: xr.Dataset, axes: tuple[Axes, Axes], reference: Mapping[str, float]) -> None:
    """Area against both reduced pressures, and the proportionality factors (thesis Fig. 3.2)."""
    left, right = axes
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value)
        p, p_r = one.reduced_pressure, one.reduced_pressure_contact_mean
        for panel, x, name, color, text in (
            (left, p, "relative_contact_area", style.WHOLE, "p^*"),
            (left, p_r, "relative_contact_area", style.CONTACT, "p_r^*"),
            (right, p, "kappa", style.WHOLE, r"\kappa"),
            (right, p_r, "kappa_r", style.CONTACT, r"\kappa_r"),
            (right, p_r, "kappa_r_bond", style.PAIRS, r"\kappa_r"),
        ):
            pairs = " (pairs)" if color == style.PAIRS else ""
            style.with_errors(panel, x, one, name, color=color, label=rf"$H={value:g}$, ${text}${pairs}", **look)
    dense = np.geomspace(float(data.reduced_pressure.min()), float(data.reduced_pressure.max()), 100)
    left.plot(dense, analytic.persson_area(dense), color=style.EXACT, lw=0.8, label=r"Persson (2D), erf$(\sqrt{2}p^*)$")
    right.axhline(reference["kappa_r"], color=style.EXACT, lw=0.8, label=f"thesis, {reference['kappa_r']:g}")
    left.set(
        xscale="log",
        yscale="log",
        xlabel=r"reduced pressure $p^*$, $p_r^*$",
        ylabel=r"relative contact area $a_{\mathrm{rel}}$",
    )
    right.set(xscale="log", xlabel=r"reduced pressure $p^*$, $p_r^*$", ylabel=r"$\kappa^{1D}$, $\kappa_r^{1D}$")
    left.legend()
    right.legend(ncols=2, loc="upper right")
    right.set_ylim(top=right.get_ylim()[1] * 1.18)


def fig_3_3(data: xr.Dataset, axes: Axes, reference: Mapping[str, float]) -> None:
    """Eq. 3.11 fitted to each Hurst exponent and to all (thesis Fig. 3.3)."""
    limit = float(data.fit_limit.min())
    low, high = float(data.reduced_pressure.min()), float(data.reduced_pressure.max())
    dense = np.geomspace(low, high, 200)
    for weighting, width, alpha in (("area", 1.4, 1.0), ("logarithm", 0.9, 0.55)):
        fit = data.sel(weighting=weighting, fit_limit=limit)
        for name in data.fitted.values:
            one = fit.sel(fitted=name)
            curve = analytic.line_area(dense, float(one.fit_b1), float(one.fit_b2)) / dense
            look = (
                {"color": "#2a9d6f", "ls": "--"}
                if name == "all"
                else {"color": style.WHOLE, "ls": style.hurst(float(name))["linestyle"]}
            )
            who = "all $H$" if name == "all" else f"$H={name}$"
            axes.plot(dense, curve, lw=width, alpha=alpha, label=f"{who}, fit of {weighting}", **look)
    for value in data.hurst.values:
        one, look = data.sel(hurst=value), style.hurst(value) | {"linestyle": "none"}
        style.with_errors(axes, one.reduced_pressure, one, "kappa", color="#888888", **look)
    axes.plot(dense, analytic.persson_area(dense) / dense, color=style.EXACT, lw=0.8, label="Persson (2D)")
    axes.set(xscale="log", xlabel=r"reduced pressure $p^*$", ylabel=r"$\kappa^{1D}_{\mathrm{fit}}$")
    axes.legend(ncols=2, fontsize=6.5)
