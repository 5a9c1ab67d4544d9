"""Compare estimators of κ and κ_r on grids of 4 points per shortest wavelength and more, as docs/continuum.md shows.

Usage: python benchmarks/estimators.py lines|surfaces [MEMBERS]
"""

from __future__ import annotations

import sys

import numpy as np
import xarray as xr

import contactsim as cs
from contactsim.observables.edge_correction import EDGE_EXCESS

PRESSURES = (1e-3, 1e-2, 1e-1)
HURST_EXPONENTS = (0.2, 0.8)
GRADIENT = 1e-3
SURFACES = {
    "lines": {"length": 160000.0, "short_cutoff": 39.0625, "dimensions": 1},
    "surfaces": {"length": 80000.0, "short_cutoff": 1250.0, "dimensions": 2},
}
"""Lines are those of Chapter 3. Surfaces have a quarter of the waves: 64 points per wavelength can then be solved."""
GRIDS = {"lines": (4, 8, 16, 32, 64, 256), "surfaces": (4, 8, 16, 32, 64)}
ESTIMATORS = ("counted", "corrected", "subgrid", "pairs", "literature")
TABLE_ESTIMATORS = {
    ("lines", "kappa"): ESTIMATORS[:3],
    ("lines", "kappa_r"): ESTIMATORS[:4],
    ("surfaces", "kappa"): (*ESTIMATORS[:3], ESTIMATORS[4]),
    ("surfaces", "kappa_r"): ESTIMATORS[:4],
}
"""Estimators in each table: pairs have the counted area, and the literature has a constant for areas of surfaces."""
LITERATURE = 0.1181
"""Part of a cell that Yastrebov et al. (2017) take off for each edge."""
SYMBOLS = {"kappa": "κ", "kappa_r": "κ_r"}
SPREAD_AT, ORDER_GRIDS = 16, (8, 16, 32)
"""Points per shortest wavelength at which the spread of members is given, and those that the order is observed on."""
SEED = 888
"""Of surfaces that no statement is judged on."""


def estimates(kind: str, members: int) -> xr.Dataset:
    """Return κ and κ_r of each member by each estimator, (estimator, hurst, pressure, points, member)."""
    grids, shape = GRIDS[kind], SURFACES[kind]
    waves = round(shape["length"] / shape["short_cutoff"])
    factors = np.zeros((2, len(ESTIMATORS), len(HURST_EXPONENTS), len(PRESSURES), len(grids), members))
    for place, hurst in enumerate(HURST_EXPONENTS):
        for member in range(members):
            surface = cs.SelfAffine(
                hurst_exponent=hurst, long_cutoff=20000.0, rms_gradient=GRADIENT, seed=(SEED, member), **shape
            )
            loads = cs.pressures([pressure * GRADIENT for pressure in PRESSURES])
            scene = cs.Scene(cs.HalfSpace(contact_modulus=1.0), surface, cs.HardWall(), loads)
            for grid, points in enumerate(grids):
                data = cs.simulate(scene, points=waves * points, tolerance=1e-3)
                factors[:, :, place, :, grid, member] = _factors(data)
    coordinates = {
        "estimator": list(ESTIMATORS), "hurst": list(HURST_EXPONENTS), "pressure": list(PRESSURES),
        "points": list(grids), "member": range(members),
    }  # fmt: skip
    kappa, kappa_r = (xr.DataArray(part, coordinates, list(coordinates)) for part in factors)
    return xr.Dataset({"kappa": kappa, "kappa_r": kappa_r})


def _factors(data: xr.Dataset) -> np.ndarray:
    """Return κ and κ_r by each estimator at each load, (2, estimator, load)."""
    area, gradient = "relative_contact_area", "rms_gradient_contact"
    edges = (data[area] - data[f"{area}_corrected"]) / EDGE_EXCESS[2 if "length_y" in data else 1]
    areas = [
        data[area],
        data[f"{area}_corrected"],
        data[f"{area}_subgrid"],
        data[area],
        data[area] - LITERATURE * edges,
    ]
    slopes = [data[f"{gradient}{end}"] for end in ("", "_corrected", "_subgrid", "_pairs", "_corrected")]
    pressure = data.mean_pressure.values
    kappa = np.array([part.values * GRADIENT / pressure for part in areas])
    return np.stack([kappa, np.array([part.values for part in slopes]) / GRADIENT * kappa])


def stated_error(values: xr.DataArray, is_surface: bool) -> xr.DataArray:
    """Return the error of the corrected estimator: its last change, or the distance to the second one if larger.

    The second one counts from 16 points per shortest wavelength; that of surfaces without its error of second order.
    """
    corrected, subgrid = values.sel(estimator="corrected"), values.sel(estimator="subgrid")
    change = abs(corrected - corrected.shift(points=1))
    second = subgrid + ((subgrid - subgrid.shift(points=1)) / 3 if is_surface else 0.0)
    return xr.where(values.points >= 16, np.maximum(change, abs(second - corrected)), change)


def print_table(kind: str, name: str, factors: xr.DataArray) -> None:
    """Print how far each estimator is from the finest grid, its spread and order, and how often its error covers that.

    kind: lines or surfaces; name: of the factor; factors: of each member
    """
    values = factors.mean("member")
    finest = values.sel(estimator="subgrid").isel(points=-1)
    distances = 100 * (factors / factors.sel(estimator="subgrid").isel(points=-1) - 1)
    print(
        f"| {SYMBOLS[name]} by | H | p* | {' | '.join(str(count) for count in values.points.values)} | spread | order |"
    )
    print("|---" * (5 + values.points.size) + "|")
    for estimator in TABLE_ESTIMATORS[kind, name]:
        for hurst in HURST_EXPONENTS:
            for pressure in PRESSURES:
                place = {"estimator": estimator, "hurst": hurst, "pressure": pressure}
                off = 100 * (values.sel(place) / finest.sel(hurst=hurst, pressure=pressure) - 1)
                spread = float(distances.sel(place | {"points": SPREAD_AT}).std("member", ddof=1))
                cells = [estimator, f"{hurst:g}", f"{pressure:g}", *(f"{number:+.2f}" for number in off.values)]
                print(f"| {' | '.join([*cells, f'{spread:.2f}', _order(values.sel(place))])} |")
    corrected = values.sel(estimator="corrected")
    between = corrected.points.values[1:-1].tolist()
    errors = stated_error(values, kind == "surfaces")
    covered = {
        truth: int((abs(corrected - target) <= errors).sel(points=between).sum())
        for truth, target in (("subgrid", finest), ("corrected", corrected.isel(points=-1)))
    }
    cases = errors.sel(points=between).size
    print(
        f"\nOn {between[0]} to {between[-1]} points the stated error covers the distance to the finest *subgrid* number"
        f" in {covered['subgrid']} of {cases} cases, and to the finest *corrected* one in {covered['corrected']}.\n"
    )


def _order(values: xr.DataArray) -> str:
    """Return the order by the changes between 8, 16 and 32 points; a dash where they turn their sign."""
    coarse, middle, fine = values.sel(points=list(ORDER_GRIDS)).values
    ratio = (coarse - middle) / (middle - fine)
    return f"{np.log2(ratio):.1f}" if ratio > 0 else "–"


def main() -> None:
    """Print the tables of κ and κ_r."""
    kind = sys.argv[1]
    factors = estimates(kind, int(sys.argv[2]) if len(sys.argv) > 2 else 6)
    for name in SYMBOLS:
        print_table(kind, name, factors[name])


if __name__ == "__main__":
    main()
