"""Analyse published datasets again, without contactsim: another definition of contact, and a power law.

Contact is where the gap is less than a fraction of the range of adhesion. Its area follows from the histograms of gaps
in `ch5_rough_adhesive.nc`. The area in `ch3_rough_line.nc` is fitted by a power of the pressure for each member: area
and pressure are proportional if the exponent is one.

    python examples/reanalyse.py FOLDER
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import xarray as xr

GAP_LIMITS = (0.0, 0.5, 1.0)
"""Largest gaps in contact, over the range of adhesion; each is the edge of a bin, and bins are 0.25 wide."""
MAX_REDUCED_PRESSURE = 0.1
"""Reduced pressure up to which the power is fitted."""


def is_solved(data: xr.Dataset) -> xr.DataArray:
    """Return True where the state was solved; members with fewer steps have NaN there."""
    meanings = data.status.attrs["flag_meanings"].split()
    values = dict(zip(meanings, data.status.attrs["flag_values"], strict=True))
    return data.status.isin([values["converged"], values["interpolated"]])


def mean_over_members(values: xr.DataArray) -> xr.Dataset:
    """Return the mean over members and its standard error."""
    error = values.std("member", ddof=1) / np.sqrt(values.count("member"))
    return xr.Dataset({"mean": values.mean("member"), "error": error})


def area_closer_than(data: xr.Dataset, limit: float) -> xr.DataArray:
    """Return the fraction of points whose gap is below a limit, for each member and each snapshot."""
    area = data.normal_gap_share.where(data.normal_gap_bin < limit, 0.0).sum("normal_gap_bin")
    approach = data.approach - data.approach_first_touch
    step = abs(approach - data.snapshot).argmin("step")
    return area.where(is_solved(data).isel(step=step))


def fit_power_law(data: xr.Dataset) -> xr.Dataset:
    """Return the exponent n and factor c of area = c p*^n for each member, by least squares of the logarithms."""
    low = data.sel(reduced_pressure=data.reduced_pressure <= MAX_REDUCED_PRESSURE * (1 + 1e-9))
    area = low.relative_contact_area.where(is_solved(low))
    line = np.log(area).assign_coords(reduced_pressure=np.log(low.reduced_pressure))
    fit = line.polyfit("reduced_pressure", 1).polyfit_coefficients
    return xr.Dataset({"n": fit.sel(degree=1, drop=True), "c": np.exp(fit.sel(degree=0, drop=True))})


def main() -> None:
    """Print the areas and the fits with standard errors over members."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="the folder that holds datasets/")
    datasets = parser.parse_args().folder / "datasets"

    data = xr.load_dataset(datasets / "ch5_rough_adhesive.nc")
    print("relative area where the gap is below a part of the range of adhesion")
    print("work_of_separation  approach " + "".join(f"{f'< {limit:g}':>22}" for limit in GAP_LIMITS))
    areas = [mean_over_members(area_closer_than(data, limit)) for limit in GAP_LIMITS]
    for work in data.work_of_separation.values:
        for approach in data.snapshot.values:
            rows = [area.sel(work_of_separation=work, snapshot=approach) for area in areas]
            numbers = "".join(f"{row['mean'].item():12.6f} ± {row.error.item():.5f}" for row in rows)
            print(f"{work:14g} N/m {approach:6g} nm {numbers}")

    data = xr.load_dataset(datasets / "ch3_rough_line.nc")
    fit = fit_power_law(data)
    n, c = mean_over_members(fit.n), mean_over_members(fit.c)
    print(f"\narea = c p*^n, p* up to {MAX_REDUCED_PRESSURE:g}\nhurst {'n':>20} {'c':>20}")
    for exponent in data.hurst_exponent.values:
        numbers = (
            f"{row['mean'].sel(hurst_exponent=exponent):12.5f} ± {row.error.sel(hurst_exponent=exponent):.5f}"
            for row in (n, c)
        )
        print(f"{exponent:5g} " + " ".join(numbers))


if __name__ == "__main__":
    main()
