"""Deposited results analysed anew, without the code that made them: another contact, and another law.

Contact is counted by a definition of one's own, where surfaces are closer than a part of the range of adhesion, from
the shares of gaps that `ch5_rough_adhesive.nc` keeps of every member. And the area of `ch3_rough_line.nc` is fitted by
a power of the pressure, member by member: area and pressure are proportional where the exponent is one.

    python examples/reanalyse.py FOLDER
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import xarray as xr

CLOSE = (0.0, 0.5, 1.0)
"""Gaps below which there is contact, over the range of adhesion: ends of bins, of which each is a quarter wide."""
LARGEST = 0.1
"""Reduced pressure up to which the power is fitted."""


def solved(data: xr.Dataset) -> xr.DataArray:
    """Where there is a solution; NaN, as of a member that has fewer steps, is none."""
    meanings = data.status.attrs["flag_meanings"].split()
    values = dict(zip(meanings, data.status.attrs["flag_values"], strict=True))
    return data.status.isin([values["converged"], values["interpolated"]])


def over_members(values: xr.DataArray) -> xr.Dataset:
    """Mean over members and its standard error."""
    error = values.std("member", ddof=1) / np.sqrt(values.count("member"))
    return xr.Dataset({"mean": values.mean("member"), "error": error})


def closer_than(data: xr.Dataset, limit: float) -> xr.DataArray:
    """Part of the points whose gap is below a limit, of each member at each approach that gaps are kept of."""
    found = data.normal_gap_share.where(data.normal_gap_bin < limit, 0.0).sum("normal_gap_bin")
    approach = data.approach - data.approach_first_touch
    step = abs(approach - data.snapshot).argmin("step")
    return found.where(solved(data).isel(step=step))


def power_law(data: xr.Dataset) -> xr.Dataset:
    """Exponent n and factor c of area = c p*^n, by least squares of the logarithms, of each member."""
    low = data.sel(reduced_pressure=data.reduced_pressure <= LARGEST * (1 + 1e-9))
    area = low.relative_contact_area.where(solved(low))
    line = np.log(area).assign_coords(reduced_pressure=np.log(low.reduced_pressure))
    found = line.polyfit("reduced_pressure", 1).polyfit_coefficients
    return xr.Dataset({"n": found.sel(degree=1, drop=True), "c": np.exp(found.sel(degree=0, drop=True))})


def main() -> None:
    """Print both, with standard errors over members."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="the folder that holds datasets/")
    datasets = parser.parse_args().folder / "datasets"

    data = xr.load_dataset(datasets / "ch5_rough_adhesive.nc")
    print("relative area where the gap is below a part of the range of adhesion")
    print("work_of_separation  approach " + "".join(f"{f'< {limit:g}':>22}" for limit in CLOSE))
    areas = [over_members(closer_than(data, limit)) for limit in CLOSE]
    for work in data.work_of_separation.values:
        for approach in data.snapshot.values:
            found = [area.sel(work_of_separation=work, snapshot=approach) for area in areas]
            numbers = "".join(f"{one['mean'].item():12.6f} ± {one.error.item():.5f}" for one in found)
            print(f"{work:14g} N/m {approach:6g} nm {numbers}")

    data = xr.load_dataset(datasets / "ch3_rough_line.nc")
    fit = power_law(data)
    n, c = over_members(fit.n), over_members(fit.c)
    print(f"\narea = c p*^n, p* up to {LARGEST:g}\nhurst {'n':>20} {'c':>20}")
    for exponent in data.hurst_exponent.values:
        numbers = (
            f"{one['mean'].sel(hurst_exponent=exponent):12.5f} ± {one.error.sel(hurst_exponent=exponent):.5f}"
            for one in (n, c)
        )
        print(f"{exponent:5g} " + " ".join(numbers))


if __name__ == "__main__":
    main()
