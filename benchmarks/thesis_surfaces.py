"""Solve the rough surfaces of Chapter 3 on the thesis's own grid, 16384 × 16384 points, and on coarser ones.

    python benchmarks/thesis_surfaces.py            # an hour and 11 GB of memory
    python benchmarks/thesis_surfaces.py --redraw   # the tables of docs/continuum.md from the measurements

Each load is solved in a process of its own, on one thread. A row that is in `thesis_surfaces.csv` is not solved again,
so a stopped run goes on where it stopped.
"""

from __future__ import annotations

import itertools
import logging
import sys
from pathlib import Path

import pandas as pd
from measure import run_in_child
from records import Table, on_one_thread
from report import insert

from contactsim import simulate
from contactsim.study.plan import Plan
from contactsim.study.scenes import build_scene

ROOT = Path(__file__).resolve().parents[1]
PAGE, FILE = ROOT / "docs/continuum.md", ROOT / "benchmarks/thesis_surfaces.csv"
BEGIN, END = "<!-- thesis surfaces: written by benchmarks/thesis_surfaces.py -->", "<!-- end of thesis surfaces -->"
HURST_EXPONENTS, PRESSURES = (0.2, 0.5, 0.8), (1e-3, 1.23e-2, 1e-1)
MEMBERS = {2048: 3, 4096: 3, 8192: 3, 16384: 1}
"""Members by the number of points a side; they are the first of the standard tier."""
THESIS_POINTS = max(MEMBERS)
ENDS = ("", "_corrected", "_subgrid")
"""Ends of the names of the three estimators."""
FACTORS = tuple(f"{name}{end}" for end in ENDS for name in ("kappa", "kappa_r"))
COSTS = ("transforms", "seconds", "bytes_per_point", "certificate")

logger = logging.getLogger("thesis_surfaces")


def peak_bytes() -> float:
    """Return the largest memory of this process so far."""
    return float(Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()[0]) * 1024


def solve_case(plan: Plan, case: dict) -> dict:
    """Return κ and κ_r of a load by three estimators, and what it cost."""
    study, points = plan.studies["rough_surface"], case["points"]
    wanted = {"hurst_exponent": case["hurst_exponent"]}, case["member"]
    run = next(run for run in study.runs() if (run.coordinates, run.member) == wanted)
    load = {"name": "reduced_pressure", "values": [case["reduced_pressure"]]}
    gradient = run.settings["surface"]["rms_gradient"]
    scene = build_scene(run.settings | {"points": points, "load": load})

    def solve() -> dict:
        """Return the numbers of the solution."""
        before = peak_bytes()
        data = simulate(scene, points=points, tolerance=1e-3, keep=[])
        memory = (peak_bytes() - before) / points**2
        data = data.isel(step=0)
        numbers = {}
        for end in ENDS:
            kappa_over_gradient = data[f"relative_contact_area{end}"] * scene.contact_modulus / data.mean_pressure
            numbers[f"kappa{end}"] = float(kappa_over_gradient * gradient)
            numbers[f"kappa_r{end}"] = float(kappa_over_gradient * data[f"rms_gradient_contact{end}"])
        costs = (data.transforms, data.seconds, memory, max(float(data.max_contact_gap), float(data.penetration)))
        return numbers | dict(zip(COSTS, map(float, costs), strict=True))

    result = run_in_child(solve)
    assert result is not None  # no limit of time is set
    return result


def carried(rows: pd.DataFrame, name: str) -> pd.Series:
    """Return a counted number carried to the thesis's grid, as statements have it."""
    corrected = rows[f"{name}_corrected"]
    return corrected + (rows[name] - corrected) * rows.points / THESIS_POINTS


def tables(rows: pd.DataFrame) -> str:
    """Return the tables of the page: both numbers of the first member on all grids, and what they cost."""
    place = ["hurst_exponent", "reduced_pressure"]
    parts = []
    for name, symbol in {"kappa": "κ", "kappa_r": "κ_r"}.items():
        first = rows[rows.member == 0].assign(carried=lambda part, name=name: carried(part, name))
        counted, moved, corrected = (
            first.pivot_table(index=place, columns="points", values=column)
            for column in (name, "carried", f"{name}_corrected")
        )
        grids = [points for points in MEMBERS if points < THESIS_POINTS]
        head = [f"counted, {THESIS_POINTS}", *(f"carried from {points}" for points in grids)]
        head += [f"corrected, {points}" for points in MEMBERS]
        lines = [f"| {symbol}: H | p* | " + " | ".join(head) + " |", "|---" * (2 + len(head)) + "|"]
        for key in counted.index:
            values = [counted.loc[key, THESIS_POINTS], *moved.loc[key, grids], *corrected.loc[key, list(MEMBERS)]]
            lines.append(f"| {key[0]:g} | {key[1]:g} | " + " | ".join(f"{value:.4f}" for value in values) + " |")
        parts.append("\n".join(lines))
    costs = rows.groupby("points")[["transforms", "seconds", "bytes_per_point"]].mean()
    lines = ["| points | transforms of a load | CPU s of a load | bytes a point | GB |", "|---|---|---|---|---|"]
    for points, row in costs.iterrows():
        memory = row.bytes_per_point * points**2 / 1e9
        numbers = f"{row.transforms:.0f} | {row.seconds:.0f} | {row.bytes_per_point:.1f} | {memory:.1f}"
        lines.append(f"| {points}² | {numbers} |")
    return "\n\n".join([*parts, "\n".join(lines)])


def main() -> None:
    """Solve what is missing, and write the tables."""
    if "--redraw" not in sys.argv:
        on_one_thread()
        plan = Plan.read(ROOT / "config", "standard")
        table = Table(FILE, ("points", "hurst_exponent", "reduced_pressure", "member"), (*FACTORS, *COSTS))
        for points, members in MEMBERS.items():
            for hurst, pressure, member in itertools.product(HURST_EXPONENTS, PRESSURES, range(members)):
                case = {"points": points, "hurst_exponent": hurst, "reduced_pressure": pressure, "member": member}
                table.row(case, lambda case: solve_case(plan, case))
    insert(PAGE, BEGIN, tables(pd.read_csv(FILE)), END)


if __name__ == "__main__":
    main()
