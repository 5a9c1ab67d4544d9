"""Films: a figure drawn for one stored state after another, at even steps of the load, the approach or the slide."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from contactsim.dataset import settings_of
from contactsim.errors import InputError
from contactsim.figures import style
from contactsim.grid import Array
from contactsim.variables import LOADS

DPI = 100
"""Dots an inch of a frame."""
COLOURS, COLOUR_DISTANCE = 24, 24
"""Most colours of a film, and the least sum of their differences in red, green and blue, of 255 each."""
CODE = np.array([1 << 16, 1 << 8, 1], np.uint32)
"""What red, green and blue count in the number of a colour."""
LAST_SECONDS = 1.5
"""Time for which the last frame stays."""
SNAPSHOT = "snapshot"
"""Dimension of the states of a path that have fields."""


def frame_dimension(data: xr.Dataset) -> str:
    """Return the dimension along which a dataset holds fields: snapshots of a path, or loads.

    Raises
    ------
    InputError
        Where it holds no fields along such a dimension.
    """
    fields = {str(dim) for name in data.data_vars if "x" in data[name].dims for dim in data[name].dims}
    dims = [dim for dim in (SNAPSHOT, *LOADS) if dim in fields]
    if not dims:
        allowed = "a dataset with fields: of a study with `snapshots`, or with loads and `keep: [fields]`"
        raise InputError("film", sorted(map(str, data.dims)), allowed)
    return dims[0]


def snapshot_steps(path: xr.Dataset) -> Array:
    """Return the step of each snapshot of a path of one member."""
    along = _driving_quantity(path)
    away = np.abs(along - path[SNAPSHOT].values[:, None])
    steps = np.nanargmin(away, axis=1)
    far = np.nanmin(away, axis=1) > style.PLACE_TOLERANCE
    if far.any():
        raise InputError(SNAPSHOT, path[SNAPSHOT].values[far].tolist(), "values of steps of the path")
    return steps


def _driving_quantity(path: xr.Dataset) -> Array:
    """Return the quantity that drives a path, at each step, counted as in the settings."""
    if "sliding_distance" in path:
        return path.sliding_distance.values
    values = path[str(path.control.values)].values
    touch = settings_of(path)["load"].get("origin") == "first_touch"
    return values - float(path.approach_first_touch) if touch else values


def states_after_jumps(path: xr.Dataset) -> list[int]:
    """Return the number of the first snapshot after each jump that the solver found, but for jumps before all of them.

    path: of one member
    """
    steps = snapshot_steps(path)
    after = np.searchsorted(steps, np.flatnonzero(path.jump.values > 0))
    return [int(state) for state in after if 0 < state < steps.size]


def choose_frames(data: xr.Dataset, count: int) -> list[int]:
    """Return the numbers of the states with fields that a film shows, in the order of the path.

    They are the stored states nearest to even steps in the driving quantity: the load, the approach or the sliding
    distance, to and fro. The last state before and the first state after each jump that the solver found are among
    them, as successive frames.

    Parameters
    ----------
    data : of one variant and member
    count : frames at even steps
    """
    path, dim = data.squeeze("member"), frame_dimension(data)
    after = states_after_jumps(path) if dim == SNAPSHOT else []
    return sorted({*_nearest_to_even(path[dim].values, count), *after, *(state - 1 for state in after)})


def _nearest_to_even(values: Array, count: int) -> list[int]:
    """Return the places of the values nearest to even steps of the way through all of them."""
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(values)))])
    even = np.linspace(0.0, way[-1], count)
    return np.unique(np.abs(way - even[:, None]).argmin(axis=1)).tolist()


def write_film(
    figure: Figure, draw: Callable[[int], object], frames: Sequence[int], frames_per_second: float, path: Path
) -> None:
    """Write a figure as an animated GIF that repeats.

    Parameters
    ----------
    figure : with empty panels
    draw : draws one state, by its number, on the panels; it gives them the same limits for all states
    frames : numbers of the states
    frames_per_second : of all but the last, which stays longer
    path : of the file
    """
    first, *others = reduce_colours(draw_frames(figure, draw, frames))
    milliseconds = [1000 / frames_per_second] * len(others) + [1000 * LAST_SECONDS]
    first.save(path, format="GIF", save_all=True, append_images=others, duration=milliseconds, loop=0)


def draw_frames(figure: Figure, draw: Callable[[int], object], frames: Sequence[int]) -> list[Array]:
    """Return the pictures of the states, (height, width, 3) each; the panels stay where the last state has them."""
    canvas = FigureCanvasAgg(figure)
    figure.set_dpi(DPI)
    draw(frames[-1])
    canvas.draw()
    figure.set_layout_engine("none")
    pictures = []
    for frame in frames:
        for panel in figure.axes:
            panel.clear()
        draw(frame)
        canvas.draw()
        pictures.append(np.array(canvas.buffer_rgba())[..., :3])
    return pictures


def reduce_colours(pictures: Sequence[Array]) -> list[Image.Image]:
    """Return pictures in few colours, which they share: a film of few colours is small.

    Colours of lines and areas stay as they are; shades between them, at their edges, become the nearest colours.
    """
    places = [np.unique(picture.astype(np.uint32) @ CODE, return_inverse=True) for picture in pictures]
    counted = [np.bincount(indices.ravel()) for _, indices in places]
    codes, order = np.unique(np.concatenate([own for own, _ in places]), return_inverse=True)
    counts = np.bincount(order, np.concatenate(counted))
    colours = np.stack([codes >> 16, codes >> 8 & 255, codes & 255], axis=-1).astype(int)
    palette = _distinct_colours(colours[np.argsort(-counts, kind="stable")])
    nearest = np.abs(colours[:, None] - palette).sum(axis=-1).argmin(axis=1).astype(np.uint8)
    reduced = []
    for picture, (own, indices) in zip(pictures, places, strict=True):
        values = nearest[np.searchsorted(codes, own)][indices]
        image = Image.fromarray(values.reshape(picture.shape[:2]), "P")
        image.putpalette(palette.astype(np.uint8).tobytes())
        reduced.append(image)
    return reduced


def _distinct_colours(colours: Array) -> Array:
    """Return the first colours of a list, (colours, 3), that differ enough from those before them."""
    chosen = colours[:1]
    for colour in colours[1:]:
        if len(chosen) < COLOURS and np.abs(chosen - colour).sum(axis=1).min() > COLOUR_DISTANCE:
            chosen = np.append(chosen, colour[None], axis=0)
    return chosen
