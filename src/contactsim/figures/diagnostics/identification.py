"""Statements of Chapter 6 in all candidates for the cell of its probe: map, shares, pairs that never hold together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PathCollection
from matplotlib.colors import ListedColormap, Normalize

from contactsim.analysis.candidate_shares import (
    DRAWN,
    SETS,
    holds_together,
    incompatible_pairs,
    shares_table,
    statements_held,
)
from contactsim.figures import style
from contactsim.figures.layout import empty_figure, save

LARGE, SMALL, RING = 52.0, 14.0, 130.0
"""Areas of the markers of candidates that are admitted and not, and of the ring of the second set, points²."""
SET_LOOKS = {SETS[0]: ("admitted", style.CONTACT, 0.16), SETS[1]: ("and the signs of the text", style.WHOLE, -0.16)}
"""Words, colour and shift along the axis of each set of candidates."""
SMALL_FONT = 6.5


@mpl.rc_context(style.RC_PARAMS)
def write_identification(plan: Mapping[str, Any], candidates: pd.DataFrame, targets: Mapping[str, str]) -> None:
    """Plot the candidates and write the files.

    Parameters
    ----------
    plan : of `contactsim.evaluation.identification.settings.figure_job`
    candidates : one row for each candidate and statement
    targets : png, pdf, svg and csv
    """
    held = statements_held(candidates)
    figure, panels = empty_figure(plan["settings"] | {"panels": 2}, footer_text(plan["tier"], candidates), rows=2)
    points = plot_map(panels[0], held, held.width / 1000, r"$w$ (µm)")
    plot_map(panels[1], held, held.thickness / held.width, "$h/w$")
    figure.colorbar(points, ax=panels[1], label=f"statements that hold, of {candidates.claim.nunique()}", pad=0.01)
    plot_shares(panels[2], shares_table(candidates))
    image = plot_pairs(panels[3], candidates)
    figure.colorbar(image, ax=panels[3], label="candidates in which both hold", pad=0.01)
    style.add_letters(panels)
    save(figure, shares_table(candidates), targets)


def footer_text(tier: str, candidates: pd.DataFrame) -> str:
    """Return the numbers of candidates, of states without a solution, and of pairs that never hold together."""
    cells = candidates.drop_duplicates("candidate")
    drawn = cells[cells.candidate.astype(str).str.fullmatch(DRAWN)]
    counts = {name: int(drawn[name].astype(bool).sum()) for name in (*SETS, "isolated")}
    dropped = ": that rule is dropped" if counts[SETS[0]] > counts["isolated"] else ""
    return (
        f"{tier} tier · {len(drawn)} candidates drawn, {counts['isolated']} apart from their replicas{dropped} · "
        f"{counts[SETS[0]]} admitted, {counts[SETS[1]]} with the text's signs · "
        f"{int((cells.unsolved > 0).sum())} candidates with states without a solution · "
        f"{len(incompatible_pairs(candidates))} pairs of statements never hold together · "
        "the cells of studies enter no share"
    )


def plot_map(axes: Axes, held: pd.DataFrame, across: pd.Series, label: str) -> PathCollection:
    """Plot how many statements hold in each candidate over a length and the lattice constant; return the markers.

    held: of `statements_held`; across: value of each candidate, on a logarithmic axis
    """
    drawn = held.candidate.astype(str).str.fullmatch(DRAWN)
    norm = Normalize(held.holding.min(), max(held.holding.max(), held.holding.min() + 1))
    sizes = np.where(held[SETS[0]].astype(bool), LARGE, SMALL)
    for rows, marker in ((~drawn, "s"), (drawn, "o")):
        look: dict[str, Any] = {
            "norm": norm,
            "cmap": "viridis",
            "marker": marker,
            "edgecolors": style.EXACT,
            "linewidths": 0.4,
        }
        points = axes.scatter(
            across[rows], held.lattice_constant[rows], s=sizes[rows], c=held.holding[rows], zorder=3, **look
        )
    ringed = held[SETS[1]].astype(bool)
    ring: dict[str, Any] = {"s": RING, "facecolors": "none", "edgecolors": style.WHOLE, "linewidths": 0.9}
    axes.scatter(across[ringed], held.lattice_constant[ringed], **ring)
    axes.set(xscale="log", xlabel=label, ylabel="lattice constant $l$ (nm)")
    style.set_log_ticks(axes.xaxis, *axes.get_xlim())
    return points


def plot_shares(axes: Axes, shares: pd.DataFrame) -> None:
    """Plot the share of the candidates of both sets in which each statement holds; shares: of `shares_table`."""
    places = np.arange(len(shares))[::-1]
    for group, (words, colour, shift) in SET_LOOKS.items():
        share, error = shares[f"{group}_share"], shares[f"{group}_error"]
        look = style.marker_look(colour, size=3.0, fill=colour) | {"ls": "none", "label": words}
        axes.errorbar(share, places + shift, xerr=error, **look, **style.BARS)
    axes.set(xlim=(-0.05, 1.05), xlabel="share of decided candidates in which it holds", ylim=(-1.0, len(shares) + 1.2))
    axes.set_yticks(places, [claim_label(claim) for claim in shares.claim], fontsize=SMALL_FONT)
    axes.grid(axis="y", lw=0.3)
    axes.legend(loc="upper left", ncols=2)


def plot_pairs(axes: Axes, candidates: pd.DataFrame) -> ScalarMappable:
    """Plot in how many candidates two statements hold together; those that never do are red."""
    counts = holds_together(candidates)
    names = list(counts)
    shades = ListedColormap(mpl.colormaps["Greys"](np.linspace(0.0, 0.75, 64)))
    image = axes.imshow(counts.to_numpy(), cmap=shades, vmin=0)
    for first, second in incompatible_pairs(candidates)[["first", "second"]].itertuples(index=False):
        for row, column in ((first, second), (second, first)):
            corner = names.index(column) - 0.5, names.index(row) - 0.5
            axes.add_patch(mpl.patches.Rectangle(corner, 1, 1, color=style.WHOLE, lw=0))
    labels = [claim_label(name) for name in names]
    axes.set_xticks(range(len(names)), labels, rotation=90, fontsize=SMALL_FONT)
    axes.set_yticks(range(len(names)), labels, fontsize=SMALL_FONT)
    axes.tick_params(length=0)
    return image


def claim_label(claim: str) -> str:
    """Return the name of a claim in words."""
    return claim.replace("_", " ")
