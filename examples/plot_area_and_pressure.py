"""
Contact area of rough lines against pressure
============================================

Self-affine lines with the Hurst exponents 0.2 and 0.8 are pressed from light to complete contact. Six members of each
are joined into one xarray dataset, which gives means and standard errors. Persson's theory, erf(√2 p*), is right close
to complete contact. At low pressure the lines have a larger area.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

import contactsim as cs
from contactsim.reference.persson import persson_area

# %%
# All pressures are reduced ones, p* = p/(E* ḡ). ``cs.pressures`` takes pressures in GPa.
contact_modulus, rms_gradient = 1.0, 0.1  # GPa, –
reduced = np.geomspace(3e-3, 3.0, 16)
path = cs.pressures(reduced * contact_modulus * rms_gradient)


def press_line(hurst_exponent, seed):
    """Return the dataset of one line, pressed by all loads."""
    line = cs.SelfAffine(
        length=8e3,
        hurst_exponent=hurst_exponent,
        long_cutoff=1e3,
        short_cutoff=16.0,
        rms_gradient=rms_gradient,
        seed=seed,
    )  # nm
    scene = cs.Scene(cs.HalfSpace(contact_modulus), line, cs.HardWall(), path)
    return cs.simulate(scene, points=16384, keep=["contact"])


# %%
# Each dataset has the dimension ``step``. ``xr.concat`` adds the members and the Hurst exponents.
names = ["relative_contact_area_subgrid", "mean_pressure", "status"]
exponents, members = [0.2, 0.8], range(6)
data = xr.concat(
    [xr.concat([press_line(exponent, seed)[names] for seed in members], "member") for exponent in exponents],
    "hurst_exponent",
).assign_coords(hurst_exponent=exponents, step=reduced)
assert (data.status == 0).all()  # each state has converged

area = data.relative_contact_area_subgrid
mean = area.mean("member")
error = area.std("member", ddof=1) / np.sqrt(area.sizes["member"])

# %%
# κ is the area over p*. Persson's theory has √(8/π) = 1.6 at low pressure. That of the lines falls with the pressure.
kappa, kappa_error = mean / data.step, error / data.step
persson_kappa = persson_area(reduced) / reduced

figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 3.8), layout="constrained")
for axes, values, errors, exact in (
    (left, mean, error, persson_area(reduced)),
    (right, kappa, kappa_error, persson_kappa),
):
    for exponent, marker in zip(exponents, "os", strict=True):
        bars = errors.sel(hurst_exponent=exponent)
        axes.errorbar(reduced, values.sel(hurst_exponent=exponent), bars, fmt=marker, ms=4, label=f"H = {exponent}")
    axes.plot(reduced, exact, "k-.", lw=1, label=r"Persson, erf$(\sqrt{2}p^*)$")
    axes.set(xscale="log", xlabel="reduced pressure p* = p/(E* ḡ)")
left.set(yscale="log", ylabel="relative contact area")
right.set(ylabel="κ = relative contact area / p*", ylim=(0, None))
left.legend()
print("κ at p* = 0.003:", kappa.isel(step=0).values.round(2), "±", kappa_error.isel(step=0).values.round(2))
