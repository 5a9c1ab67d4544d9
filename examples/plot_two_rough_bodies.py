"""
Two rough bodies, from mated to shifted
=======================================

Two bodies have surfaces that fit together, as the faces of a fracture do. Mated, they touch everywhere. One is moved
along x by more and more points: the contact area falls to that of two independent surfaces. A single surface whose rms
gradient is √2 times as large has the same area.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs

# %%
# Heights of each body are positive towards the other, so the second surface that fits the first is minus the first.
points, length, rms_gradient = 256, 1000.0, 0.1
contact_modulus, mean_pressure = 1.0, 0.01  # GPa, that of the pair
spacing = length / points  # nm


def rough(seed):
    """Return the heights of a self-affine surface, nm."""
    surface = cs.SelfAffine(
        length=length,
        hurst_exponent=0.5,
        long_cutoff=200.0,
        short_cutoff=25.0,
        rms_gradient=rms_gradient,
        dimensions=2,
        seed=seed,
    )
    return surface.heights(points)


first = rough(1)
second = -first
load = {"spacing": spacing, "contact_modulus": contact_modulus, "mean_pressure": mean_pressure}

# %%
# ``offset=(0, k)`` moves the second body by k points along x.
offsets = np.array([0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64])
areas = np.array([cs.press(first, second, offset=(0, int(k)), **load).relative_contact_area for k in offsets])

# %%
# Two independent surfaces, and one surface with √2 times the heights against a flat.
independent = np.mean([cs.press(first, rough(seed), **load).relative_contact_area for seed in (2, 3, 4, 5)])
single = np.mean([cs.press(np.sqrt(2) * rough(seed), **load).relative_contact_area for seed in (1, 2, 3, 4)])
print(
    f"mated: {areas[0]:.3f}; independent surfaces: {independent:.4f}; single surface, √2 times as steep: {single:.4f}"
)

figure, axes = plt.subplots(1, 3, figsize=(12, 3.7), layout="constrained", width_ratios=[1, 1, 1.2])
extent = (0, length, 0, length)
for panel, k in zip(axes[:2], (2, 64), strict=True):
    result = cs.press(first, second, offset=(0, k), **load)
    pressure = np.ma.masked_where(~result.contact, 1e3 * result.pressure)
    image = panel.imshow(pressure, origin="lower", extent=extent, cmap="inferno_r")
    figure.colorbar(image, ax=panel, label="pressure (MPa)")
    panel.set(xlabel="x (nm)", ylabel="y (nm)", title=f"moved by {k * spacing:.0f} nm")
axes[2].plot(offsets * spacing, areas, "o-", label="moved along x")
axes[2].axhline(independent, color="k", ls="-.", lw=1, label="independent surfaces")
axes[2].axhline(single, color="C3", ls=":", label="one surface, √2 times as steep")
axes[2].set(xlabel="distance moved along x (nm)", ylabel="relative contact area")
axes[2].legend(loc="upper right")
