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
from report import insert, markdown

from contactsim import simulate
from contactsim.analysis.carried import carry
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
PLACE = ["hurst_exponent", "reduced_pressure"]
ENDS_OF_MEANS = ("carried", "corrected")
"""Ends of the names of the numbers whose means over members are given."""
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


def tables(rows: pd.DataFrame) -> str:
    """Return the tables of the page: κ and κ_r of the first member and of all, and what they cost."""
    factors = {"kappa": "κ", "kappa_r": "κ_r"}
    rows = rows.assign(
        **{
            f"{name}_carried": carry(rows[name], rows[f"{name}_corrected"], rows.points / THESIS_POINTS)
            for name in factors
        }
    )
    first = [first_member_table(rows[rows.member == 0], name, symbol) for name, symbol in factors.items()]
    return "\n\n".join([*first, member_table(rows, factors), cost_table(rows)])


def first_member_table(rows: pd.DataFrame, name: str, symbol: str) -> str:
    """Return the table of the first member: counted on the thesis's grid, carried there, and corrected on each grid."""
    counted, carried, corrected = (
        rows.pivot_table(index=PLACE, columns="points", values=column).reindex(columns=list(MEMBERS))
        for column in (name, f"{name}_carried", f"{name}_corrected")
    )
    grids = [points for points in MEMBERS if points < THESIS_POINTS]
    header = [f"{symbol}: H", "p*", f"counted, {THESIS_POINTS}", *(f"carried from {points}" for points in grids)]
    header += [f"corrected, {points}" for points in MEMBERS]
    lines = []
    for place in counted.index:
        values = [counted.loc[place, THESIS_POINTS], *carried.loc[place, grids], *corrected.loc[place]]
        lines.append([f"{key:g}" for key in place] + [f"{value:.4f}" for value in values])
    return markdown(header, lines)


def member_table(rows: pd.DataFrame, factors: dict[str, str]) -> str:
    """Return the means over members on the finest grid that several have, each with its standard error."""
    several = max(points for points, members in MEMBERS.items() if members > 1)
    groups = rows[rows.points == several].groupby(PLACE)
    columns = {f"{symbol} {end}": f"{name}_{end}" for name, symbol in factors.items() for end in ENDS_OF_MEANS}
    means, errors = groups[list(columns.values())].mean(), groups[list(columns.values())].sem()
    lines = [
        [f"{key:g}" for key in place]
        + [f"{means.loc[place, name]:.4f} ± {errors.loc[place, name]:.4f}" for name in columns.values()]
        for place in means.index
    ]
    return markdown([f"{MEMBERS[several]} members, {several}²: H", "p*", *columns], lines)


def cost_table(rows: pd.DataFrame) -> str:
    """Return the mean costs of a load on each grid."""
    costs = rows.groupby("points")[["transforms", "seconds", "bytes_per_point"]].mean()
    lines = [
        [f"{points}²", f"{row.transforms:.0f}", f"{row.seconds:.0f}", f"{row.bytes_per_point:.1f}"]
        + [f"{row.bytes_per_point * points**2 / 1e9:.1f}"]
        for points, row in costs.iterrows()
    ]
    return markdown(["points", "transforms of a load", "CPU s of a load", "bytes a point", "GB"], lines)


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
