"""Shares of candidates with binomial errors, and pairs of statements that no candidate meets together."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest

from contactsim.analysis.candidate_shares import (
    HoldingShare,
    holding_candidates,
    holds_together,
    incompatible_pairs,
    shares_table,
    statements_held,
)
from contactsim.analysis.verdict import NOT_DECIDABLE, NOT_REPRODUCED, REPRODUCED

VERDICTS = {"y": REPRODUCED, "n": NOT_REPRODUCED, "?": NOT_DECIDABLE}


def candidates(**marks):
    """A table of cells c1, c2, …: a letter of `VERDICTS` for each cell by claim; all are admitted."""
    rows = [
        {"candidate": f"c{number}", "claim": claim, "verdict": VERDICTS[mark], "admitted": True, "unsolved": 0}
        | {"admitted_by_signs": number % 2 == 0, "apart": number == 1}
        | {"width": 1e3, "thickness": 1e3, "lattice_constant": 2.0}
        for claim, letters in marks.items()
        for number, mark in enumerate(letters, start=1)
    ]
    return pd.DataFrame(rows)


def test_the_binomial_error_is_that_of_draws_and_is_not_zero_at_the_ends():
    draws = np.random.default_rng(1).binomial(50, 0.3, 4000) / 50
    assert HoldingShare(50, 15).error == pytest.approx(draws.std(), rel=0.05)
    assert HoldingShare(10, 10).error == pytest.approx(HoldingShare(10, 0).error)
    assert HoldingShare(10, 0).error > 0.05
    assert math.isnan(HoldingShare(0, 0).share)
    assert math.isnan(HoldingShare(0, 0).error)


def test_a_share_is_of_the_decided_drawn_candidates_of_a_set():
    table = candidates(a="yn?y")
    assert holding_candidates(table, "a", "admitted") == HoldingShare(3, 2)
    assert holding_candidates(table, "a", "admitted_by_signs") == HoldingShare(2, 1)
    assert holding_candidates(table, "a", "apart") == HoldingShare(1, 1)
    named = table.assign(candidate=table.candidate.replace("c1", "default"))
    assert holding_candidates(named, "a", "admitted") == HoldingShare(2, 1)
    shares = shares_table(table).iloc[0]
    assert shares.admitted_share == pytest.approx(2 / 3)


def test_pairs_that_never_hold_together_both_hold_somewhere_and_are_decided_together():
    table = candidates(a="yyn", b="nny", never="nnn", c="yyy", unknown="??y")
    pairs = incompatible_pairs(table)
    assert pairs[["first", "second"]].to_numpy().tolist() == [["a", "b"], ["a", "unknown"]]
    assert pairs.decided.tolist() == [3, 1]
    assert holds_together(table).loc["a", "c"] == 2
    assert holds_together(table).loc["c", "c"] == 3
    apart = candidates(a="y?", b="?y")
    assert incompatible_pairs(apart).empty


def test_statements_are_counted_in_each_candidate():
    held = statements_held(candidates(a="yn", b="y?"))
    assert held.holding.tolist() == [2, 0]
    assert held.decided.tolist() == [2, 1]
