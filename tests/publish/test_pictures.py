"""Pictures in few colours keep what colours mean."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from contactsim.publish.pictures import COLOURS, flat_colours, reduce_colours

BLUE, ORANGE, YELLOW = (86, 180, 233), (213, 94, 0), (240, 228, 66)


@pytest.fixture
def figure():
    """A noisy picture with a large blue area, and two small patches of a legend."""
    pixels = np.random.default_rng(1).integers(0, 256, (300, 400, 3)).astype(np.uint8)
    pixels[100:] = BLUE
    pixels[200:206, 20:32] = ORANGE
    pixels[200:206, 60:72] = YELLOW
    return Image.fromarray(pixels)


def test_the_colours_of_small_flat_areas_are_kept(figure):
    few = reduce_colours(figure, figure).convert("RGB")
    assert [few.getpixel(place) for place in ((26, 203), (66, 203), (200, 280))] == [ORANGE, YELLOW, BLUE]
    assert len(few.getcolors(COLOURS)) <= COLOURS


def test_a_palette_of_all_pixels_alone_would_drop_them(figure):
    few = figure.quantize(128, dither=Image.Dither.NONE).convert("RGB")
    assert few.getpixel((26, 203)) != ORANGE


def test_flat_colours_are_those_of_areas_the_largest_first(figure):
    assert flat_colours(figure).tolist()[0] == list(BLUE)
    assert {tuple(colour) for colour in flat_colours(figure).tolist()} >= {BLUE, ORANGE, YELLOW}


def test_a_picture_that_was_scaled_has_the_colours_of_its_source(figure):
    few = reduce_colours(figure.resize((200, 150), Image.Resampling.LANCZOS), figure).convert("RGB")
    assert few.getpixel((13, 101)) == ORANGE
