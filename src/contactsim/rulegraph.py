"""The rules of a workflow as a drawing: columns from what needs nothing to what is asked for, lines between them."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from graphlib import TopologicalSorter

from markupsafe import Markup, escape

NODE, EDGE = re.compile(r'(\d+)\[label = "(\w+)"'), re.compile(r"(\d+) -> (\d+)")
"""Lines of dot, as snakemake writes them."""
ACROSS, DOWN, WIDTH, HEIGHT = 175, 42, 130, 26
"""Distances of boxes and their size, in pixels."""


def ask(tier: str) -> subprocess.Popen:
    """Ask snakemake for the graph of what `all` needs at a tier; it takes seconds."""
    command = ["--dry-run", "--rulegraph", "dot", "all", "--config", f"tier={tier}"]
    pipe = subprocess.PIPE
    return subprocess.Popen([sys.executable, "-m", "snakemake", *command], stdout=pipe, stderr=pipe, text=True)


def answer(asked: subprocess.Popen) -> str:
    """The graph as dot; RuntimeError with what snakemake says where it makes none."""
    graph, told = asked.communicate()
    if asked.returncode:
        raise RuntimeError(told)
    return graph


def drawn(dot: str, together: Mapping[str, str]) -> Markup:
    """A graph of rules in dot as SVG; rules that `together` gives the same name are one box."""
    names = {key: together.get(name, name) for key, name in NODE.findall(dot)}
    needs: dict[str, set[str]] = {name: set() for name in names.values()}
    for first, then in EDGE.findall(dot):
        if names[first] != names[then]:
            needs[names[then]].add(names[first])
    order = list(TopologicalSorter({name: sorted(needs[name]) for name in sorted(needs)}).static_order())
    needs = _direct(needs, order)
    places = _places(needs, order)
    width = max((x for x, _ in places.values()), default=0) + WIDTH + 20
    height = max((y for _, y in places.values()), default=0) + HEIGHT + 20
    lines = [_line(places[one], places[name]) for name, others in needs.items() for one in sorted(others)]
    boxes = [_box(name, place) for name, place in places.items()]
    text = "".join(lines + boxes)
    return Markup(f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="rules">{text}</svg>')


def _direct(needs: Mapping[str, set[str]], order: list[str]) -> dict[str, set[str]]:
    """What each rule needs, without what one of its needs already needs; order: each after its needs."""
    every: dict[str, set[str]] = {}
    for name in order:
        every[name] = needs[name].union(*(every[one] for one in needs[name]))
    return {name: {one for one in needs[name] if not any(one in every[two] for two in needs[name])} for name in order}


def _places(needs: Mapping[str, set[str]], order: list[str]) -> dict[str, tuple[int, int]]:
    """Upper left corner of each box: as far to the right as what needs it allows, columns centred."""
    left: dict[str, int] = {}
    for name in reversed(order):
        left[name] = 1 + max((left[other] for other in order if name in needs[other]), default=-1)
    last = max(left.values(), default=0)
    columns = {column: sorted(name for name in order if last - left[name] == column) for column in range(last + 1)}
    tallest = max(map(len, columns.values()), default=0)
    return {
        name: (10 + column * ACROSS, 10 + row * DOWN + (tallest - len(own)) * DOWN // 2)
        for column, own in columns.items()
        for row, name in enumerate(own)
    }


def _line(start: tuple[int, int], end: tuple[int, int]) -> str:
    (x, y), (far, up) = (start[0] + WIDTH, start[1] + HEIGHT // 2), (end[0], end[1] + HEIGHT // 2)
    middle = (x + far) // 2
    return f'<path d="M{x} {y}C{middle} {y} {middle} {up} {far} {up}"/>'


def _box(name: str, place: tuple[int, int]) -> str:
    x, y = place
    text = f'<text x="{x + WIDTH // 2}" y="{y + HEIGHT // 2 + 4}">{escape(name)}</text>'
    return f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="5"/>{text}'
