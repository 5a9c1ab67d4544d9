"""The rules of a workflow as a drawing: columns from what needs nothing to what is asked for, lines between them."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Mapping
from graphlib import TopologicalSorter
from itertools import pairwise
from statistics import mean

from markupsafe import Markup, escape

NODE, EDGE = re.compile(r'(\d+)\[label = "(\w+)"'), re.compile(r"(\d+) -> (\d+)")
"""Lines of dot, as snakemake writes them."""
ACROSS, DOWN, WIDTH, HEIGHT = 175, 42, 130, 26
"""Distances of boxes and their size, in pixels."""
SWEEPS = 8
"""How often columns are put in the order of those beside them, from the left and from the right by turns."""
Stop = str | tuple[str, str, int]
"""A box, by its name, or a place that a line has in a column between its boxes."""


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
    columns = _columns(needs, order)
    lines = [_stops(one, name, columns) for name, others in needs.items() for one in sorted(others)]
    places = _places(lines, columns)
    width = max((x for x, _ in places.values()), default=0) + WIDTH + 20
    height = max((y for _, y in places.values()), default=0) + HEIGHT + 20
    text = "".join(
        [_line([places[stop] for stop in line]) for line in lines] + [_box(name, places[name]) for name in order]
    )
    return Markup(f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="rules">{text}</svg>')


def _direct(needs: Mapping[str, set[str]], order: list[str]) -> dict[str, set[str]]:
    """What each rule needs, without what one of its needs already needs; order: each after its needs."""
    every: dict[str, set[str]] = {}
    for name in order:
        every[name] = needs[name].union(*(every[one] for one in needs[name]))
    return {name: {one for one in needs[name] if not any(one in every[two] for two in needs[name])} for name in order}


def _columns(needs: Mapping[str, set[str]], order: list[str]) -> dict[str, int]:
    """The column of each box: as far to the right as what needs it allows."""
    left: dict[str, int] = {}
    for name in reversed(order):
        left[name] = 1 + max((left[other] for other in order if name in needs[other]), default=-1)
    last = max(left.values(), default=0)
    return {name: last - left[name] for name in order}


def _stops(start: str, end: str, columns: Mapping[str, int]) -> list[Stop]:
    """Where a line passes: its boxes and, in each column between them, a place of its own, where no box is."""
    return [start, *((start, end, column) for column in range(columns[start] + 1, columns[end])), end]


def _places(lines: list[list[Stop]], columns: Mapping[str, int]) -> dict[Stop, tuple[int, int]]:
    """Upper left corner of each stop; columns are centred, and in them lines cross little."""
    stops: list[list[Stop]] = [[] for _ in range(max(columns.values(), default=-1) + 1)]
    for name in sorted(columns):
        stops[columns[name]].append(name)
    for stop in (stop for line in lines for stop in line[1:-1]):
        stops[stop[2]].append(stop)
    _untangle(stops, [pair for line in lines for pair in pairwise(line)])
    tallest = max(map(len, stops), default=0)
    return {
        stop: (10 + column * ACROSS, 10 + row * DOWN + (tallest - len(own)) * DOWN // 2)
        for column, own in enumerate(stops)
        for row, stop in enumerate(own)
    }


def _untangle(stops: list[list[Stop]], steps: list[tuple[Stop, Stop]]) -> None:
    """Put each column in the order of the means of what its stops are joined with, from left and right by turns."""
    for sweep in range(SWEEPS):
        forward = sweep % 2 == 0
        for column in stops if forward else reversed(stops):
            rows = {stop: row - len(one) / 2 for one in stops for row, stop in enumerate(one)}
            beside: dict[Stop, list[float]] = {stop: [] for stop in column}
            for before, after in steps:
                stop, other = (after, before) if forward else (before, after)
                if stop in beside:
                    beside[stop].append(rows[other])
            column.sort(key=lambda stop: mean(beside[stop] or [rows[stop]]))


def _line(places: list[tuple[int, int]]) -> str:
    """A line from the right of its first place, straight through those between, to the left of its last."""
    path = ""
    for (x, y), (far, up) in pairwise(places):
        begin, y, up = x + WIDTH, y + HEIGHT // 2, up + HEIGHT // 2
        middle = (begin + far) // 2
        path += f"{'L' if path else 'M'}{begin} {y}C{middle} {y} {middle} {up} {far} {up}"
    return f'<path d="{path}"/>'


def _box(name: str, place: tuple[int, int]) -> str:
    x, y = place
    text = f'<text x="{x + WIDTH // 2}" y="{y + HEIGHT // 2 + 4}">{escape(name)}</text>'
    return f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{HEIGHT}" rx="5"/>{text}'
