"""
Measured topography without periodic images
===========================================

A square part of an elevation model that comes with matplotlib is pressed on a half-space. The scan is alone: nothing
outside its edges bears load. At high pressure its contact is as stiff as that of a square punch, 1.1523 E* over its
side. Heights that repeat have no such limit.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import get_data_path

import contactsim as cs

# %%
# The file has no positions, so the spacing is given: 30 m. A scale of 1 : 10⁸ along the plane and 1 : 10⁹ of the
# heights makes a rough surface with small slopes of the model.
scan = cs.read_topography(
    f"{get_data_path()}/sample_data/jacksboro_fault_dem.npz", variable="elevation", unit="m", spacing=30e9
)
points = 192
square = cs.Topography(scan.values[:points, :points] * 1e-9, scan.spacing[0] * 1e-8)
topography = cs.prepare_topography(square)  # a plane is subtracted
print(topography)

# %%
# ``characterise`` presses at several loads and does all once more with every second point; the change is the error.
# Heights of a measurement are alone on the half-space unless ``periodic=True``.
contact_modulus = 70.0  # GPa
pressures = np.geomspace(0.003, 30.0, 9)  # GPa
alone = cs.characterise(topography, contact_modulus=contact_modulus, mean_pressures=pressures)
repeated = cs.characterise(topography, contact_modulus=contact_modulus, mean_pressures=pressures, periodic=True)
print(
    alone[["relative_contact_area_subgrid", "contact_stiffness"]]
    .to_dataframe()
    .round({"relative_contact_area_subgrid": 4, "contact_stiffness": 6})
)

# %%
# The capacity of a square plate gives the stiffness of a square punch, dF/dδ = 1.1523 E* times its side.
side = topography.lengths[0]  # nm
punch_stiffness = 1.1523 * contact_modulus / side  # GPa/nm, for each area

# %%
# One load with its fields.
pressed = cs.press(topography, contact_modulus=contact_modulus, mean_pressure=0.1)

figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 3.7), layout="constrained")
extent = (0, side / 1e3, 0, side / 1e3)  # µm
image = left.imshow(topography.values, origin="lower", extent=extent, cmap="gray")
figure.colorbar(image, ax=left, label="height (nm)")
left.contourf(pressed.contact, [0.5, 1.5], origin="lower", extent=extent, colors="C3")
left.set(xlabel="x (µm)", ylabel="y (µm)", title="contact at 0.1 GPa (red)")
for data, label, marker in ((alone, "alone", "o"), (repeated, "periodic", "s")):
    for axes, name in ((middle, "relative_contact_area_subgrid"), (right, "contact_stiffness")):
        axes.errorbar(pressures, data[name], data[f"{name}_grid_error"], fmt=f"{marker}-", ms=4, capsize=2, label=label)
right.axhline(punch_stiffness, color="k", ls="-.", lw=1, label="square punch")
middle.set(xscale="log", yscale="log", xlabel="mean pressure (GPa)", ylabel="relative contact area")
right.set(xscale="log", yscale="log", xlabel="mean pressure (GPa)", ylabel="contact stiffness (GPa/nm)")
right.legend()
