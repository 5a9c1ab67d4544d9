"""Candidates for what the text leaves open about the probe, from a Latin hypercube."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

CELL = (("surface", "length"), ("counter_body", "thickness"), ("pairing", "lattice_constant"))
"""Keys of a study that make the cell of its probe."""
DIGITS = 5
"""Significant digits of a number that is drawn."""


@dataclass(frozen=True)
class Candidate:
    """A cell of the probe: width, thickness of the layer and lattice constant, nm."""

    name: str
    width: float
    thickness: float
    lattice_constant: float


@dataclass(frozen=True)
class CandidateRanges:
    """Least and largest width (nm), thickness over width, and lattice constant (nm)."""

    width: Sequence[float]
    thickness_ratio: Sequence[float]
    lattice_constant: Sequence[float]


def draw_candidates(seed: int, count: int, ranges: CandidateRanges) -> list[Candidate]:
    """Return candidates of a Latin hypercube.

    Parameters
    ----------
    seed
        Seed of the hypercube.
    count
        Number of candidates; each range is divided into as many parts, and each part holds one of them.
    ranges
        Ranges of a candidate; width and thickness ratio are uniform in their logarithms.
    """
    from scipy.stats import qmc  # takes longer to import than all settings to read

    places = qmc.LatinHypercube(d=3, rng=np.random.default_rng(seed)).random(count)
    low, high = np.array([np.log(ranges.width), np.log(ranges.thickness_ratio), ranges.lattice_constant], dtype=float).T
    drawn = qmc.scale(places, low, high)
    return [
        Candidate(
            drawn_name(number),
            _rounded(math.exp(log_width)),
            _rounded(math.exp(log_width + log_ratio)),
            _rounded(lattice),
        )
        for number, (log_width, log_ratio, lattice) in enumerate(drawn, start=1)
    ]


def drawn_name(number: int) -> str:
    """Return the name of a candidate that is drawn, the first of which has number 1."""
    return f"c{number:02d}"


def _rounded(value: float) -> float:
    """Return a number with `DIGITS` significant digits."""
    return float(f"{value:.{DIGITS}g}")


def has_cell(section: Mapping) -> bool:
    """Return True for a section of a study with a cell: the period, the thickness and the lattice of a probe."""
    return all(key in section.get(part, {}) for part, key in CELL)


def named_candidates(named: Mapping[str, str], sections: Mapping[str, Mapping]) -> list[Candidate]:
    """Return the cells of studies.

    Parameters
    ----------
    named
        Study of each cell by the name of the cell.
    sections
        Sections of the studies in the config.
    """
    return [
        Candidate(
            name,
            *(sections[study][part][key] for part, key in CELL),
        )
        for name, study in named.items()
    ]
