"""Vector pictures (SVG) that carry the points that they show.

A page can zoom into such a picture, and tell value and error of the point under the cursor.
"""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from xml.sax.saxutils import escape

import matplotlib as mpl
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure

from contactsim.figures.points import figure_points
from contactsim.files import write_text

POINTS_ID = "points"
"""Identifier of the element that holds the points, as JSON."""
MAX_CELLS = 2000
"""Cells of a coloured mesh that are drawn one by one; a larger mesh is drawn as pixels."""
PIXEL_DPI = 110
"""Resolution of images and of what is drawn as pixels."""
LONG_NUMBER = re.compile(r"-?\d+\.\d{3,}")
PLACES = re.compile(r'(?<= )(?:d|x|y|width|height)="[^"]*"|translate\([^)]*\)')
"""Parts of a picture that hold places on it, of which two decimals are enough."""


def write_vector(figure: Figure, path: str | Path) -> None:
    """Write a figure as SVG with its points; the same figure gives the same file."""
    meshes = [mesh for axes in figure.axes for mesh in axes.collections if isinstance(mesh, QuadMesh)]
    for mesh in meshes:
        cells = mesh.get_array()
        mesh.set_rasterized(cells is not None and cells.size > MAX_CELLS)
    file = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "contactsim"}):
        figure.savefig(file, format="svg", dpi=PIXEL_DPI, metadata={"Date": None, "Creator": None})
    picture = PLACES.sub(
        lambda place: LONG_NUMBER.sub(lambda number: f"{float(number[0]):.2f}", place[0]), file.getvalue()
    )
    points = json.dumps(figure_points(figure), ensure_ascii=False, separators=(",", ":"))
    start = picture.index(">", picture.index("<svg")) + 1
    write_text(f'{picture[:start]}<desc id="{POINTS_ID}">{escape(points)}</desc>{picture[start:]}', path)
