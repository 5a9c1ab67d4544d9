"""Compare estimators of κ and κ_r on grids of 4 points per shortest wavelength and more, as docs/continuum.md shows.

Usage: python benchmarks/estimators.py lines|surfaces [MEMBERS]
"""

from __future__ import annotations

import sys

import numpy as np
import xarray as xr

import contactsim as cs

PRESSURES = (1e-3, 1e-2, 1e-1)
HURST_EXPONENTS = (0.2, 0.8)
GRADIENT = 1e-3
SURFACES = {
    "lines": {"length": 160000.0, "short_cutoff": 39.0625, "dimensions": 1},
    "surfaces": {"length": 80000.0, "short_cutoff": 1250.0, "dimensions": 2},
}
"""Lines are those of Chapter 3. Surfaces have a quarter of the waves: 64 points per wavelength can then be solved."""
GRIDS = {"lines": (4, 8, 16, 32, 64, 256), "surfaces": (4, 8, 16, 32, 64)}
ESTIMATORS = ("counted", "corrected", "subgrid", "pairs")
SEED = 888
"""Of surfaces that no statement is judged on."""


def estimates(kind: str, members: int) -> xr.Dataset:
    """Return the means of κ and κ_r over the members by each estimator, (hurst, pressure, points)."""
    grids, shape = GRIDS[kind], SURFACES[kind]
    waves = round(shape["length"] / shape["short_cutoff"])
    sums = np.zeros((2, len(ESTIMATORS), len(HURST_EXPONENTS), len(PRESSURES), len(grids)))
    for place, hurst in enumerate(HURST_EXPONENTS):
        for member in range(members):
            surface = cs.SelfAffine(
                hurst_exponent=hurst, long_cutoff=20000.0, rms_gradient=GRADIENT, seed=(SEED, member), **shape
            )
            loads = cs.pressures([pressure * GRADIENT for pressure in PRESSURES])
            scene = cs.Scene(cs.HalfSpace(contact_modulus=1.0), surface, cs.HardWall(), loads)
            for grid, points in enumerate(grids):
                sums[:, :, place, :, grid] += _factors(cs.simulate(scene, points=waves * points, tolerance=1e-3))
    dims = ("hurst", "pressure", "points")
    coordinates = {"estimator": list(ESTIMATORS), "hurst": list(HURST_EXPONENTS), "pressure": list(PRESSURES)}
    arrays = [
        xr.DataArray(part / members, coordinates | {"points": list(grids)}, ("estimator", *dims)) for part in sums
    ]
    return xr.Dataset({"kappa": arrays[0], "kappa_r": arrays[1]})


def _factors(data: xr.Dataset) -> np.ndarray:
    """Return κ and κ_r by each estimator at each load, (2, estimator, load)."""
    area, gradient = "relative_contact_area", "rms_gradient_contact"
    areas = [data[area], data[f"{area}_corrected"], data[f"{area}_subgrid"], data[area]]
    slopes = [data[f"{gradient}{end}"] for end in ("", "_corrected", "_subgrid", "_pairs")]
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


def print_table(name: str, values: xr.DataArray, is_surface: bool) -> None:
    """Print the distance of each estimator from the finest grid in per cent, and how often the error covers it."""
    finest = values.sel(estimator="subgrid").isel(points=-1)
    print(f"| {name} by | H | p* | " + " | ".join(f"{count:d}" for count in values.points.values) + " |")
    print("|---" * (3 + values.points.size) + "|")
    distance = 100 * (values / finest - 1)
    for estimator in ESTIMATORS if name == "κ_r" else ESTIMATORS[:-1]:  # pairs have the counted area
        for hurst in HURST_EXPONENTS:
            for pressure in PRESSURES:
                row = distance.sel(estimator=estimator, hurst=hurst, pressure=pressure)
                cells = " | ".join(f"{number:+.2f}" for number in row.values)
                print(f"| {estimator} | {hurst:g} | {pressure:g} | {cells} |")
    inner = values.isel(points=slice(1, -1))
    covers = abs(inner.sel(estimator="corrected") - finest) <= stated_error(values, is_surface).isel(
        points=slice(1, -1)
    )
    print(f"\nThe stated error covers the distance in {int(covers.sum())} of {covers.size} cases.\n")


def main() -> None:
    """Print the tables of κ and κ_r."""
    kind = sys.argv[1]
    values = estimates(kind, int(sys.argv[2]) if len(sys.argv) > 2 else 6)
    for name, symbol in {"kappa": "κ", "kappa_r": "κ_r"}.items():
        print_table(symbol, values[name], kind == "surfaces")


if __name__ == "__main__":
    main()
