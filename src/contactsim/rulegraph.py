"""The rules of a workflow as a drawing: columns from what needs nothing to what is asked for, lines between them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from graphlib import TopologicalSorter

from markupsafe import Markup, escape

NODE, EDGE = re.compile(r'(\d+)\[label = "(\w+)"'), re.compile(r"(\d+) -> (\d+)")
"""Lines of dot, as snakemake writes them."""
ACROSS, DOWN, WIDTH, HEIGHT = 175, 42, 130, 26
"""Distances of boxes and their size, in pixels."""


def drawn(dot: str, together: Mapping[str, str]) -> Markup:
    """A graph of rules in dot as SVG; rules that `together` gives the same name are one box."""
    names = {key: together.get(name, name) for key, name in NODE.findall(dot)}
    needs: dict[str, set[str]] = {name: set() for name in names.values()}
    for first, then in EDGE.findall(dot):
        if names[first] != names[then]:
            needs[names[then]].add(names[first])
    places = _places(needs)
    width = max((x for x, _ in places.values()), default=0) + WIDTH + 20
    height = max((y for _, y in places.values()), default=0) + HEIGHT + 20
    lines = [_line(places[one], places[name]) for name, others in needs.items() for one in sorted(others)]
    boxes = [_box(name, place) for name, place in places.items()]
    text = "".join(lines + boxes)
    return Markup(f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="rules">{text}</svg>')


def _places(needs: Mapping[str, set[str]]) -> dict[str, tuple[int, int]]:
    """Upper left corner of each box: as far to the right as the longest way to it, below those of its column."""
    depth: dict[str, int] = {}
    for name in TopologicalSorter({name: sorted(others) for name, others in sorted(needs.items())}).static_order():
        depth[name] = 1 + max((depth[one] for one in needs[name]), default=-1)
    filled: dict[int, int] = {}
    places = {}
    for name, column in sorted(depth.items(), key=lambda item: (item[1], item[0])):
        row = filled.get(column, 0)
        filled[column] = row + 1
        places[name] = (10 + column * ACROSS, 10 + row * DOWN)
    return places


def _line(start: tuple[int, int], end: tuple[int, int]) -> str:
    (x, y), (far, up) = (start[0] + WIDTH, start[1] + HEIGHT // 2), (end[0], end[1] + HEIGHT // 2)
    middle = (x + far) // 2
    return f'<path d="M{x} {y}C{middle} {y} {middle} {up} {far} {up}"/>'


def _box(name: str, place: tuple[int, int]) -> str:
    x, y = place
    text = f'<text x="{x + WIDTH // 2}" y="{y + HEIGHT // 2 + 4}">{escape(name)}</text>'
    return f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="5"/>{text}'
