"""Sketch of a scene: its bodies, the base of a layer, and the load (as in thesis Figs 2.1, 4.1, 5.1)."""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactsim.contact.scene import RIGID, Body, Scene
from contactsim.figures import style
from contactsim.grid import Array
from contactsim.traits import Trait

ELASTIC_COLOUR, RIGID_COLOUR = "#cfe3d4", "#d9d9d9"
MAX_POINTS = 2000
"""Points of a profile that are plotted."""
MIN_DEPTH, MAX_DEPTH = 0.4, 1.6
"""Depths between which a body is drawn, over the height of the profiles."""
ARROW = {"arrowstyle": "-|>", "color": "k"}


@mpl.rc_context(style.RC_PARAMS)
def save_sketch(scene: Scene, points: int, path: str | PathLike[str]) -> None:
    """Write the sketch of a scene to a file; points: of the grid along x."""
    figure = Figure(figsize=(5.2, 3.2), layout="constrained")
    plot_sketch(scene, points, figure.subplots())
    figure.savefig(path)


def plot_sketch(scene: Scene, points: int, axes: Axes) -> None:
    """Plot both bodies before they touch, with enlarged heights; points: of the grid along x."""
    nodes = np.linspace(0, points - 1, min(points, MAX_POINTS)).astype(int)
    x = nodes / points * scene.length
    lower, upper = (_section(body, points)[nodes] for body in (scene.lower, scene.upper))
    span = float(max(np.ptp(lower), np.ptp(upper)) or 1.0)
    top = lower.max() + 0.35 * span + upper.max()
    _plot_body(axes, scene.lower, _Outline(x, lower, lower.min(), lower.min() - _depth(scene.lower, span, 1.6)))
    far = top - upper.min() + _depth(scene.upper, span, 0.8)
    end = _plot_body(axes, scene.upper, _Outline(x, top - upper, (top - upper).max(), far))
    _plot_load(axes, scene, end, span)
    for edge in (0.0, scene.length):
        axes.axvline(edge, color=style.EXACT, lw=0.8, ls=(0, (4, 4)))
    axes.set(xlabel=r"$x$ (nm), periodic", ylabel=r"$z$ (nm)", xlim=(-0.02 * scene.length, 1.02 * scene.length))
    ratio = scene.length / (6 * span)
    axes.set_title(f"heights enlarged about {ratio:.2g} times" if ratio > 1.5 else "", fontsize=7, loc="right")


@dataclass(frozen=True)
class _Outline:
    """A body between its surface and a far side; near: its innermost point on the surface, nm."""

    x: Array
    surface: Array
    near: float
    far: float


def _depth(body: Body, span: float, usual: float) -> float:
    """Return the depth to which a body is drawn, nm: a layer to scale if that can be seen, else the usual one."""
    thickness = np.inf if body.elasticity is RIGID else body.elasticity.base_depth
    depth = thickness if np.isfinite(thickness) else usual * span
    return float(np.clip(depth, MIN_DEPTH * span, MAX_DEPTH * span))


def _section(body: Body, points: int) -> Array:
    """Return heights along x, (points,), through the middle of a surface."""
    heights = body.surface.heights(points)
    return heights if heights.ndim == 1 else heights[len(heights) // 2]


def _plot_body(axes: Axes, body: Body, outline: _Outline) -> float:
    """Plot a body, and the base of a layer behind it; return the height of its outer end."""
    x, far, near, elasticity = outline.x, outline.far, outline.near, body.elasticity
    axes.fill_between(x, outline.surface, far, color=RIGID_COLOUR if elasticity is RIGID else ELASTIC_COLOUR, lw=0)
    axes.plot(x, outline.surface, color=style.EXACT, lw=0.8)
    kind = "rigid"
    if elasticity is not RIGID:
        kind = rf"{type(elasticity).__name__}, $E^*$ = {elasticity.contact_modulus:g} GPa"
    label = f"{type(body.surface).__name__}, {kind}"
    axes.text(x.mean(), 0.75 * far + 0.25 * near, label, ha="center", va="center", fontsize=8)
    if elasticity is RIGID or not np.isfinite(elasticity.base_depth):
        return far
    end = far + 0.3 * (far - near)
    axes.fill_between(x, far, end, facecolor=RIGID_COLOUR, edgecolor="0.5", hatch="////", lw=0)
    place = x[x.size // 12]
    axes.annotate("", (place, near), (place, far), arrowprops={"arrowstyle": "<->", "color": "k"})
    scale = "" if np.isclose(abs(far - near), elasticity.base_depth) else ", not to scale"
    thickness = rf"$h$ = {elasticity.base_depth:g} nm{scale}"
    axes.text(x[x.size // 10], 0.75 * near + 0.25 * far, thickness, fontsize=8, va="center")
    return end


def _plot_load(axes: Axes, scene: Scene, height: float, span: float) -> None:
    """Plot arrows of the load above the upper body, and of its sliding."""
    pressed = Trait.MEAN_PRESSURE in scene.traits
    for x in np.linspace(0.1, 0.9, 5) * scene.length if pressed else (0.5 * scene.length,):
        axes.annotate("", (x, height), (x, height + 0.6 * span), arrowprops=ARROW)
    label = r"$p$" if pressed else r"$\delta$"
    axes.text(0.53 * scene.length, height + 0.4 * span, label, fontsize=9, va="center")
    if scene.sliding:
        tail, head = ((part * scene.length, height + 0.3 * span) for part in (0.62, 0.8))
        axes.annotate("", head, tail, arrowprops=ARROW)
        axes.text(0.82 * scene.length, height + 0.3 * span, "$U_x$", fontsize=9, va="center")
    axes.set_ylim(top=height + 0.75 * span)
