"""Extremes are found where they are, and none where there is only noise."""

from __future__ import annotations

import numpy as np
import pytest

from contactsim.analysis.cross_validation import MAX_SPLITS, half_splits, joint_splits

LOADS = np.log(np.geomspace(1e-3, 1e-1, 12))
SCALED = (LOADS - LOADS[0]) / np.ptp(LOADS)
SCATTER = 0.015
"""Standard deviation of κ_r of one member, as rough lines have it."""


def ensembles(level, members=10, count=150, seed=1):
    """Ensembles of members whose neighbouring loads scatter alike around a level, (count, members, loads)."""
    factor = np.linalg.cholesky(np.exp(-np.abs(LOADS[:, None] - LOADS) / 1.5))
    noise = np.random.default_rng(seed).standard_normal((count, members, LOADS.size)) @ factor.T
    return level + SCATTER * noise


def split_range(samples):
    """The range of the means, its places from one half of the members and its size from the other."""
    ranges = []
    for (first,), (second,) in joint_splits([(len(samples), np.arange(len(samples)))]):
        for searched, measured in ((first, second), (second, first)):
            order = np.argsort(samples[searched].mean(axis=0))
            means = samples[measured].mean(axis=0)
            ranges.append(means[order[-1]] - means[order[0]])
    return np.mean(ranges)


@pytest.mark.parametrize("members", [4, 10, 40])
def test_where_nothing_varies_the_split_range_is_zero_on_average_and_the_range_of_the_means_is_not(members):
    samples = ensembles(1.75, members)
    ranges = np.array([split_range(sample) for sample in samples])
    assert abs(ranges.mean()) < 3 * ranges.std() / np.sqrt(len(ranges))
    assert np.ptp(samples.mean(axis=1), axis=1).mean() > 1.5 * SCATTER / np.sqrt(members)


@pytest.mark.parametrize("level", [1.75 - 0.05 * SCALED, 1.75 + 0.2 * SCALED * (1 - SCALED)], ids=["slope", "hump"])
def test_a_range_that_is_there_stays(level):
    assert np.mean([split_range(sample) for sample in ensembles(level)]) == pytest.approx(0.05, rel=0.1)


@pytest.mark.parametrize("errors", [1, 2, 4, 8])
def test_the_split_range_of_a_slope_lies_between_zero_and_the_range_and_is_short_by_at_most_1_3_errors_of_a_mean(
    errors,
):
    level = 1.75 + errors * SCATTER / np.sqrt(10) * SCALED
    ranges = np.array([split_range(sample) for sample in ensembles(level)]) * np.sqrt(10) / SCATTER
    noise = 3 * ranges.std() / np.sqrt(len(ranges))
    assert errors - 1.3 - noise < ranges.mean() < errors + noise
    assert ranges.mean() > -noise


@pytest.mark.parametrize("members", [2, 3, 5, 10, 41])
def test_halves_are_disjoint_and_leave_no_member_out(members):
    splits = half_splits(members)
    for first, second in splits:
        assert sorted([*first, *second]) == list(range(members))
        assert abs(len(first) - len(second)) <= 1
    assert len(splits) <= MAX_SPLITS


def test_ensembles_of_different_sizes_are_split_at_once():
    splits = list(joint_splits([(size, np.arange(size)) for size in (3, 10, 1)]))
    assert len(splits) == MAX_SPLITS
    for first, second in splits:
        for left, right, size in zip(first, second, (3, 10), strict=False):
            assert sorted([*left, *right]) == list(range(size))
        assert first[2].tolist() == second[2].tolist() == [0]  # one member is both halves


@pytest.mark.parametrize("members", [10, 41])
def test_without_a_member_the_halves_are_the_same_but_for_it(members):
    left = np.delete(np.arange(members), [3, 7])
    for whole, part in zip(half_splits(members), half_splits(members, left), strict=True):
        for half, rest in zip(whole, part, strict=True):
            assert set(left[rest]) == set(half) - {3, 7}


@pytest.mark.parametrize("members", [2, 3, 4, 6])
def test_of_a_small_ensemble_all_halves_of_what_is_left_are_taken(members):
    left = np.arange(1, members)
    assert len(half_splits(members, left)) == len(half_splits(members - 1))
    for first, second in half_splits(members, left):
        assert sorted({*first, *second}) == list(range(members - 1))


def test_few_splits_of_a_small_ensemble_are_drawn_at_random_and_not_the_first_of_all():
    firsts = [first for first, _ in half_splits(8, most=12)]
    assert len(firsts) == 12
    assert len(half_splits(8)) == 70
    shares = np.mean([np.isin(np.arange(8), first) for first in firsts], axis=0)
    assert shares.max() < 1
