"""
Partial slip of a sphere
========================

A sphere is pressed on a half-space, and then sheared. It slips in a ring around a circle that sticks, as Cattaneo and
Mindlin found. The radius of the circle, the traction and the shift of the bodies have exact answers.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference import hard_wall, partial_slip

# %%
# The sphere is alone on the half-space, and its contact has the radius c.
radius, contact_radius, contact_modulus = 1e4, 100.0, 1.0  # nm, nm, GPa
friction_coefficient, poisson_ratio = 0.3, 0.3
side, points = 240.0, 192
x = (np.arange(points) - points / 2) * side / points  # nm
heights = -(x**2 + x[:, None] ** 2) / (2 * radius)
mean_pressure = hard_wall.sphere_load(contact_radius, radius, contact_modulus) / side**2  # GPa
pressed = cs.press(
    heights,
    spacing=side / points,
    contact_modulus=contact_modulus,
    mean_pressure=mean_pressure,
    periodic=False,
    tolerance=1e-6,
)

# %%
# The shear grows up to a part of μ times the pressure, at which all would slide.
ratios = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
states = [
    cs.partial_slip(
        pressed,
        shear_traction=ratio * friction_coefficient * mean_pressure,
        friction_coefficient=friction_coefficient,
        poisson_ratio=poisson_ratio,
    )
    for ratio in ratios
]
stick_radii = np.array([np.sqrt(state.relative_stick_area * side**2 / np.pi) for state in states])
shifts = np.array([state.shift for state in states])

# %%
# Exact answers: the stick radius c (1 - Q/(μP))^(1/3), and Mindlin's shift.
exact_radii = contact_radius * partial_slip.sphere_stick_ratio(ratios)
exact_shifts = partial_slip.sphere_shift(ratios, contact_radius, radius, friction_coefficient, poisson_ratio)
for row in zip(ratios, stick_radii, exact_radii, shifts, exact_shifts, strict=True):
    print("Q/(μP) = {:.1f}: stick radius {:.1f} nm, exact {:.1f}; shift {:.4f} nm, exact {:.4f}".format(*row))

figure, axes = plt.subplots(1, 3, figsize=(12, 3.7), layout="constrained")
extent = (-side / 2, side / 2, -side / 2, side / 2)
half = states[2]
image = axes[0].imshow(1e3 * half.traction, origin="lower", extent=extent, cmap="viridis")
axes[0].contour(half.stick, [0.5], origin="lower", extent=extent, colors="w", linewidths=1)
figure.colorbar(image, ax=axes[0], label="shear traction (MPa)")
axes[0].set(xlabel="x (nm)", ylabel="y (nm)", title="Q = 0.5 μP (white: edge of sticking)")
axes[1].plot(x, 1e3 * friction_coefficient * pressed.pressure[points // 2], "k:", label="μ × pressure")
for ratio, state in zip(ratios, states, strict=True):
    axes[1].plot(x, 1e3 * state.traction[points // 2], label=f"Q = {ratio:g} μP")
axes[1].set(xlabel="x (nm)", ylabel="shear traction (MPa)", ylim=(0, 3.4))
axes[1].legend(ncols=2, fontsize="small", loc="upper center")
fine = np.linspace(0, 1, 200)
axes[2].plot(
    partial_slip.sphere_shift(fine, contact_radius, radius, friction_coefficient, poisson_ratio),
    fine,
    "k-.",
    lw=1,
    label="Mindlin",
)
axes[2].plot(shifts, ratios, "o", label="simulated")
axes[2].set(xlabel="shift of the bodies (nm)", ylabel="Q/(μP)")
axes[2].legend()
