"""A scene drawn from itself: the bodies, what is rigid, what drives them (as thesis Figs 2.1, 4.1, 5.1)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contactsim.contact.scene import Body, Scene
from contactsim.figures import style
from contactsim.traits import Trait

ELASTIC, RIGID = "#cfe3d4", "#d9d9d9"


def save_sketch(scene: Scene, points: int, path: str) -> None:
    """Draw a scene into a file."""
    figure = Figure(figsize=(5.2, 3.2), layout="constrained")
    sketch(scene, points, figure.subplots())
    figure.savefig(path)


def sketch(scene: Scene, points: int, axes: Axes) -> None:
    """Both bodies before they touch, heights enlarged to be seen; at most 2000 points of the profile are drawn."""
    shown = np.linspace(0, points - 1, min(points, 2000)).astype(int)
    x = shown / points * scene.length
    lower, upper = (_section(body, points)[shown] for body in (scene.lower, scene.upper))
    span = max(np.ptp(lower), np.ptp(upper)) or 1.0
    gap = 0.35 * span
    top = lower.max() + gap + upper.max()
    below, above = _depth(scene.lower, span, 1.6), _depth(scene.upper, span, 0.8)
    _body(axes, scene.lower, x, lower, lower.min() - below, "lower")
    far = _body(axes, scene.upper, x, top - upper, top - upper.min() + above, "upper")
    _drive(axes, scene, far, span)
    for edge in (0.0, scene.length):
        axes.axvline(edge, color=style.EXACT, lw=0.8, ls=(0, (4, 4)))
    axes.set(xlabel=r"$x$ (nm), periodic", ylabel=r"$z$ (nm)", xlim=(-0.02 * scene.length, 1.02 * scene.length))
    ratio = scene.length / (6 * span)
    axes.set_title(f"heights enlarged about {ratio:.2g} times" if ratio > 1.5 else "", fontsize=7, loc="right")


def _depth(body: Body, span: float, usual: float) -> float:
    """How deep a body is drawn below its lowest point: a layer to scale where that can be seen."""
    return float(np.clip(getattr(body.elasticity, "thickness", usual * span), 0.4 * span, 1.6 * span))


def _section(body: Body, points: int) -> np.ndarray:
    """Heights along x, shape (points,), of a surface through its middle."""
    heights = body.surface.heights(points)
    return heights if heights.ndim == 1 else heights[len(heights) // 2]


def _body(axes: Axes, body: Body, x: np.ndarray, surface: np.ndarray, far: float, side: str) -> float:
    """Draw a body between its surface and a height, and the base of a layer behind; returns where it ends."""
    rigid = body.elasticity is None
    axes.fill_between(x, surface, far, color=RIGID if rigid else ELASTIC, lw=0)
    axes.plot(x, surface, color=style.EXACT, lw=0.8)
    kind = "rigid" if rigid else rf"{type(body.elasticity).__name__}, $E^*$ = {body.elasticity.contact_modulus:g} GPa"
    place = 0.75 * far + 0.25 * (surface.min() if side == "lower" else surface.max())
    thickness = getattr(body.elasticity, "thickness", None)
    axes.text(x.mean(), place, f"{type(body.surface).__name__}, {kind}", ha="center", va="center", fontsize=8)
    if thickness is None:
        return far
    near = surface.min() if side == "lower" else surface.max()
    end = far + 0.3 * (far - near)
    axes.fill_between(x, far, end, facecolor=RIGID, edgecolor="0.5", hatch="////", lw=0)
    axes.annotate("", (x[x.size // 12], near), (x[x.size // 12], far), arrowprops={"arrowstyle": "<->", "color": "k"})
    exact = "" if np.isclose(abs(far - near), thickness) else ", not to scale"
    axes.text(x[x.size // 10], 0.75 * near + 0.25 * far, rf"$h$ = {thickness:g} nm{exact}", fontsize=8, va="center")
    return end


def _drive(axes: Axes, scene: Scene, height: float, span: float) -> None:
    pressed = Trait.MEAN_PRESSURE in scene.traits
    for place in np.linspace(0.1, 0.9, 5) * scene.length if pressed else (0.5 * scene.length,):
        axes.annotate("", (place, height), (place, height + 0.6 * span), arrowprops={"arrowstyle": "-|>", "color": "k"})
    label = r"$p$" if pressed else r"$\delta$"
    axes.text(0.53 * scene.length, height + 0.4 * span, label, fontsize=9, va="center")
    if scene.sliding:
        ends = [(part * scene.length, height + 0.3 * span) for part in (0.62, 0.8)]
        axes.annotate("", *ends, arrowprops={"arrowstyle": "<|-", "color": "k"})
        axes.text(0.82 * scene.length, height + 0.3 * span, "$U_x$", fontsize=9, va="center")
    axes.set_ylim(top=height + 0.75 * span)
