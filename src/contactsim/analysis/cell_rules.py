"""Which measure of a cell separates the candidates in which a statement holds from those in which it fails."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from contactsim.analysis.candidate_shares import SETS, drawn_candidates
from contactsim.analysis.verdict import NOT_DECIDABLE, REPRODUCED
from contactsim.grid import Array

CELL = ("width", "thickness", "lattice_constant")
"""Lengths of a cell."""


@dataclass(frozen=True)
class CellRule:
    """A statement holds on one side of a boundary of a measure of the cell.

    Attributes
    ----------
    boundary
        Value of the measure half way, by logarithms, between the two cells beside it.
    side
        "above" or "below": where the statement holds.
    right
        Number of decided cells of which the rule is true.
    """

    boundary: float
    side: str
    right: int


def admitted_cells(candidates: pd.DataFrame, claim: str) -> pd.DataFrame:
    """Return the rows of a claim in the candidates that are drawn and admitted."""
    return drawn_candidates(candidates, claim, SETS[0])


def measure_logarithm(cells: pd.DataFrame, exponents: Mapping[str, float]) -> Array:
    """Return the logarithm of a measure of each cell, (cell,); exponents: of its lengths, as in `separate_cells`."""
    return np.sum([power * np.log(cells[name].to_numpy()) for name, power in exponents.items()], axis=0)


def separate_cells(cells: pd.DataFrame, exponents: Mapping[str, float]) -> CellRule | None:
    """Return the boundary that tells most of the decided cells apart; None unless the claim both holds and fails.

    Parameters
    ----------
    cells
        Rows of one claim, of `admitted_cells`.
    exponents
        Exponent of each length in the measure, for example 1 of the width and -2 of the lattice constant.
    """
    decided = cells[cells.verdict != NOT_DECIDABLE]
    holds = (decided.verdict == REPRODUCED).to_numpy()
    if holds.all() or not holds.any():
        return None
    logarithm = measure_logarithm(decided, exponents)
    order = np.argsort(logarithm)
    sorted_holds, sorted_logarithm = holds[order], logarithm[order]
    places = np.arange(1, len(holds))
    held_below = np.cumsum(sorted_holds)[:-1]
    failed_above = (~sorted_holds).sum() - (places - held_below)
    right_below = held_below + failed_above
    right = {"below": right_below, "above": len(holds) - right_below}
    side = max(right, key=lambda name: right[name].max())
    place = int(right[side].argmax())
    boundary = float(np.exp((sorted_logarithm[place] + sorted_logarithm[place + 1]) / 2))
    return CellRule(boundary, side, int(right[side][place]))


def cell_texts(candidates: pd.DataFrame, claim: str, exponents: Mapping[str, float] | None) -> dict[str, str]:
    """Return the numbers of cells in which a claim holds, fails and is not decided, and what separates them, as texts.

    Parameters
    ----------
    candidates
        Verdicts in all candidates, one row for each candidate and claim.
    claim
        Name of the statement.
    exponents
        Measure of the cell as in `separate_cells`; None for none.
    """
    cells = admitted_cells(candidates, claim)
    undecided, holding = int((cells.verdict == NOT_DECIDABLE).sum()), int((cells.verdict == REPRODUCED).sum())
    numbers = {"holding": holding, "failing": len(cells) - holding - undecided, "undecided": undecided}
    texts = {f"cells_{name}": str(number) for name, number in numbers.items()}
    texts |= {"cells_decided": str(len(cells) - undecided), "cells_admitted": str(len(cells))}
    rule = separate_cells(cells, exponents) if exponents else None
    if rule is not None:
        decided = len(cells) - undecided
        right = f"all {decided}" if rule.right == decided else f"{rule.right} of the {decided}"
        texts |= {
            "cells_right": f"{right} cells that are decided",
            "side": rule.side,
            "boundary": f"{float(f'{rule.boundary:.2g}'):g}",
        }
    return texts
