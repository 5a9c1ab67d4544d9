"""Look for the condition under which a statement holds: the largest block of loads and variants that satisfies it.

All statements that fail on their whole selection are searched in the same way (docs/judging.md).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

from contactsim.analysis.comparison import Comparison
from contactsim.analysis.reductions import REDUCTIONS
from contactsim.analysis.uncertainty import Estimate, estimate

MIN_SHARE = 0.5
"""Least share of a selection that a condition covers."""
MAX_BLOCKS = 12
"""Largest number of blocks whose errors are estimated for one claim."""

Block = dict[str, list[float]]
"""Least and largest value of each dimension that a block narrows."""


@dataclass(frozen=True)
class Condition:
    """A block of a selection in which a statement holds.

    Attributes
    ----------
    block
        Least and largest value of each dimension that it narrows.
    share
        Its share of the loads and variants of the selection.
    number
        The number there, with its errors.
    """

    block: Block
    share: float
    number: Estimate


@dataclass(frozen=True)
class Candidate:
    """A block that may be the condition; its numbers are computed once, and only if somebody asks.

    Attributes
    ----------
    block, share
        As of `Condition`.
    part
        What the claim compares there.
    """

    block: Block
    share: float
    part: Comparison

    @cached_property
    def numbers(self) -> tuple[float, float]:
        """The number of the block, with and without the bias of extremes."""
        return self.part.number(self.part.data), self.part.unbiased_number(self.part.data)

    @cached_property
    def estimate(self) -> Estimate:
        """The number of the block with its errors."""
        return estimate(self.part)


class ConditionSearch:
    """Search for the condition of a claim, with one band after another.

    Parameters
    ----------
    comparison
        What the claim compares, where it selects it.
    """

    def __init__(self, comparison: Comparison) -> None:
        self._comparison = comparison

    @cached_property
    def _candidates(self) -> list[Candidate]:
        """All blocks that are not empty, the largest first."""
        blocks = narrower_blocks(self._comparison)
        candidates = (Candidate(block, share, self._comparison.select(block)) for block, share in blocks)
        return [candidate for candidate in candidates if not candidate.part.is_empty]

    def find(self, band: tuple[float, float], holds: Callable[[Estimate], bool]) -> Condition | None:
        """Return the largest block in which the claim holds; None without one of at least `MIN_SHARE` of the selection.

        Parameters
        ----------
        band
            Smallest and largest value that the statement allows.
        holds
            Function of a number with its errors that is True where the statement holds.
        """
        low, high = band
        promising = (one for one in self._candidates if any(low < number < high for number in one.numbers))
        for candidate in itertools.islice(promising, MAX_BLOCKS):
            if holds(candidate.estimate):
                return Condition(candidate.block, candidate.share, candidate.estimate)
        return None


def narrower_blocks(comparison: Comparison) -> Iterator[tuple[Block, float]]:
    """Yield the contiguous blocks of a selection that are smaller than it, with their shares; the largest first.

    A dimension along which a claim compares values keeps at least two. It keeps all if the ends are compared, or if the
    claim says so, as another clause of its sentence is about that dimension.
    """
    choices = []
    claim = comparison.claim
    compares_ends = claim["reduce"] in REDUCTIONS and REDUCTIONS[claim["reduce"]].compares_ends
    for dim, values in comparison.varied_dimensions().items():
        is_compared = dim in (claim["along"], claim["across"])
        is_whole = dim in (claim["whole"] or ()) or (is_compared and compares_ends)
        least = len(values) if is_whole else 2 if is_compared else 1
        ranges = [
            (dim, [float(values[first]), float(values[last])], (last - first + 1) / len(values))
            for first, last in itertools.combinations_with_replacement(range(len(values)), 2)
            if last - first + 1 >= least
        ]
        choices.append(ranges)
    blocks = []
    for parts in itertools.product(*choices):
        share = math.prod(part for _, _, part in parts)
        if MIN_SHARE <= share < 1:
            blocks.append(({dim: ends for dim, ends, part in parts if part < 1}, share))
    yield from sorted(blocks, key=lambda block: -block[1])
