"""Pictures of the page of a report, as parts of its file: figures, and sketches of scenes."""

from __future__ import annotations

import base64
import gzip
import io
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
from matplotlib.figure import Figure
from PIL import Image

from contactsim.figures import style
from contactsim.figures.sketch import plot_sketch
from contactsim.study.scenes import build_setup

SKETCH = (4.6, 2.9), 160
"""Size in inches and dots an inch of a sketch."""
PIXEL_RATIO = 2
"""Pixels of a drawn picture for each pixel of the page, along one side."""
WEBP_QUALITY = 35
"""Quality of the pixels of a picture, up to 100."""
MAX_PIXELS = 800_000
"""Most pixels of a picture that has a vector picture too."""
SECTION_POINTS = 2000
"""Points of a drawn section of a surface."""


@dataclass(frozen=True)
class Picture:
    """A picture of the page: its bytes as a data URL, its size on the page in pixels, and the packed vector picture."""

    source: str
    width: int
    height: int
    vector: str = ""


def figure_picture(folder: Path, name: str) -> Picture:
    """Return the picture of a figure, with its vector picture."""
    vector = (folder / "figures" / f"{name}.svg").read_bytes()
    packed = base64.b64encode(gzip.compress(vector, mtime=0)).decode()
    return _embedded(folder / "figures" / f"{name}.png", packed)


def film_picture(folder: Path, name: str) -> Picture:
    """Return the film of a figure, as its file has it."""
    file = (folder / "figures" / f"{name}.gif").read_bytes()
    with Image.open(io.BytesIO(file)) as film:
        return Picture("data:image/gif;base64," + base64.b64encode(file).decode(), *film.size)


@mpl.rc_context(style.RC_PARAMS)
def sketch_picture(run: dict) -> Picture:
    """Return the sketch of a run's scene."""
    size, dots = SKETCH
    figure, file = Figure(figsize=size, layout="constrained"), io.BytesIO()
    setup = build_setup(run)
    scene = setup.scene
    surface = scene.upper.surface
    enough = max(SECTION_POINTS, 2 * (surface.modes or 0) + 2)  # of a large surface one section is drawn
    points = setup.points
    plot_sketch(scene, points if surface.points else min(points, enough), figure.subplots())
    figure.savefig(file, format="png", dpi=dots)
    return _embedded(file)


def _embedded(source: Path | io.BytesIO, vector: str = "") -> Picture:
    """Return a picture for the page.

    vector: the packed vector picture; where there is one, the pixels are seen for a moment or in print, and few will do
    """
    file = io.BytesIO()
    with Image.open(source) as picture:
        size = picture.width // PIXEL_RATIO, picture.height // PIXEL_RATIO
        pixels = picture.convert("RGB")
        if vector:
            share = min(1.0, (MAX_PIXELS / (size[0] * size[1])) ** 0.5)
            pixels = pixels.resize((round(share * size[0]), round(share * size[1])), Image.Resampling.LANCZOS)
        pixels.save(file, format="webp", quality=WEBP_QUALITY, method=6)
    return Picture("data:image/webp;base64," + base64.b64encode(file.getvalue()).decode(), *size, vector)
