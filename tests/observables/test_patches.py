"""Patches of contact: those of scipy without periods, merged across the ends with them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage

from contactsim.observables.patches import AREA_BINS, find_patches


def drawn(text: str) -> np.ndarray:
    """Return the contact set that is drawn with crosses."""
    rows = np.array([[letter == "x" for letter in row] for row in text.split()])
    return rows[0] if len(rows) == 1 else rows


@pytest.mark.parametrize("shape", [(300,), (40, 30)])
def test_without_periods_they_are_those_of_scipy(shape):
    contact = np.random.default_rng(0).random(shape) < 0.55
    found, (labels, count) = find_patches(contact, periodic=False), ndimage.label(contact)
    assert found.count == count
    assert np.array_equal(found.labels, labels)
    assert np.array_equal(found.points, ndimage.sum_labels(contact, labels, np.arange(1, count + 1)))


@pytest.mark.parametrize("shape", [(300,), (40, 30)])
def test_with_periods_they_are_those_of_the_middle_of_many_copies(shape):
    contact = np.random.default_rng(1).random(shape) < 0.4
    found = find_patches(contact)
    copies = ndimage.label(np.tile(contact, (3,) * len(shape)))[0]
    middle = copies[tuple(slice(size, 2 * size) for size in shape)]
    assert found.points.sum() == contact.sum()
    for axis in range(len(shape)):  # neighbours across the ends are alike
        pairs = np.stack([found.labels.take(0, axis).ravel(), found.labels.take(-1, axis).ravel()])
        assert np.array_equal(*pairs[:, (pairs > 0).all(0)])
    for label in np.unique(middle[middle > 0]):  # what is connected in the middle is connected
        assert np.unique(found.labels[middle == label]).size == 1
    sizes = np.bincount(copies.ravel())[np.unique(middle[middle > 0])]
    assert set(sizes) == set(found.points)  # no patch is longer than a period here


@pytest.mark.parametrize(
    ("text", "periodic", "points", "spans"),
    [
        ("x..x", True, [2], (False,)),
        ("x..x", False, [1, 1], (False,)),
        ("....", True, [], (False,)),
        ("xxxx", True, [4], (True,)),
        ("x..x .... x..x", True, [4], (False, False)),
        ("x..x .... x..x", False, [1, 1, 1, 1], (False, False)),
        ("xxxx ...x ....", False, [5], (False, True)),
        ("x... x... x...", True, [3], (True, False)),
        ("xx.. .... ..xx", True, [2, 2], (False, False)),
        ("xx.. .xxx x..x", True, [7], (True, True)),
    ],
)
def test_patches_that_are_drawn(text, periodic, points, spans):
    found = find_patches(drawn(text), periodic)
    assert sorted(found.points) == sorted(points)
    assert found.count == len(points)
    assert found.spans == spans


def test_patches_are_counted_by_their_area():
    contact = np.zeros((16, 16), bool)
    contact[0, 0] = contact[3, 3:5] = True  # one point and two of 256: 2^-8 and 2^-7 of the area
    contact[8:12, 4:12] = True  # 32 points: 2^-3
    counts = find_patches(contact).counts_by_area
    assert counts.sum() == 3
    places = np.flatnonzero(counts)
    assert AREA_BINS[places] == pytest.approx(np.sqrt(2) * np.array([2.0**-8, 2.0**-7, 2.0**-3]))
    assert find_patches(np.ones(8, bool)).counts_by_area[-1] == 1  # full contact is in the last bin
