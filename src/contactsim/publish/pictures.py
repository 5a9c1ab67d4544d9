"""Pictures in few colours, none of which changes what it means."""

from __future__ import annotations

import numpy as np
from PIL import Image

from contactsim.grid import Array

COLOURS, KEPT = 256, 64
"""Colours of a picture, and how many of them are colours of flat areas of its source, kept as they are."""


def reduce_colours(picture: Image.Image, source: Image.Image) -> Image.Image:
    """Return a picture in few colours, among them those of flat areas.

    A palette made from all pixels would drop the colours of small areas, such as those of a legend.

    Parameters
    ----------
    picture
        Picture in red, green and blue.
    source
        The same picture before it was scaled.
    """
    kept = flat_colours(source)
    rest = picture.quantize(COLOURS - len(kept), dither=Image.Dither.NONE).getpalette() or []
    palette = Image.new("P", (1, 1))
    palette.putpalette([*kept.ravel().tolist(), *rest][: 3 * COLOURS])
    return picture.quantize(palette=palette, dither=Image.Dither.NONE)


def flat_colours(source: Image.Image) -> Array:
    """Return the most frequent colours of points whose neighbours have the same one, (colours, 3)."""
    pixels = np.asarray(source.convert("RGB")).astype(np.uint32)
    codes = pixels[..., 0] << 16 | pixels[..., 1] << 8 | pixels[..., 2]
    inner = codes[1:-1, 1:-1]
    neighbours = codes[:-2, 1:-1], codes[2:, 1:-1], codes[1:-1, :-2], codes[1:-1, 2:]
    flat = np.logical_and.reduce([inner == neighbour for neighbour in neighbours])
    values, counts = np.unique(inner[flat], return_counts=True)
    frequent = values[np.argsort(-counts.astype(int), kind="stable")[:KEPT]]
    return np.stack([frequent >> 16, frequent >> 8 & 255, frequent & 255], axis=-1)
