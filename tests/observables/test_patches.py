"""Patches of contact: those of scipy without periods, merged across the ends with them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage

from contactsim.observables.patches import find_patches


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
