"""
Cylinder and sphere against Hertz
=================================

A cylinder and a sphere are pressed on a half-space, on finer and finer grids. Exact answers are known: the half-width
of the contact of parallel cylinders one period apart, and the approach of a sphere by Hertz. The error over many loads
shows the order of convergence.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference import hard_wall

# %%
# Twelve loads press contacts of half-width or radius c, from 60 to 140 nm. An error on one grid depends on how its
# points lie at the edge of the contact, so the rms error over the loads is taken.
radius, contact_modulus = 1e4, 1.0  # nm, GPa
sizes = np.linspace(60.0, 140.0, 12)  # nm


def rms(errors):
    """Return the rms of relative errors."""
    return np.sqrt(np.mean(np.square(errors)))


# %%
# Cylinder. It repeats after a period, which shifts the exact answer a little. ``relative_contact_area`` counts points;
# ``relative_contact_area_subgrid`` places each edge between points by the gap beside it.
period = 2000.0  # nm
loads = hard_wall.cylinder_array_load(sizes, radius, period, contact_modulus)  # N/m
scene = cs.Scene(
    cs.HalfSpace(contact_modulus), cs.Cylinder(period, radius), cs.HardWall(), cs.pressures(loads / period)
)
cylinder_points = np.array([200, 400, 800, 1600, 3200])
counted, cylinder_errors = [], []
for points in cylinder_points:
    line = cs.simulate(scene, points=int(points), tolerance=1e-7)
    counted.append(rms(line.relative_contact_area.values * period / 2 / sizes - 1))
    cylinder_errors.append(rms(line.relative_contact_area_subgrid.values * period / 2 / sizes - 1))

# %%
# Sphere. ``FreeHalfSpace`` has no periodic images: the sphere is alone, as in the theory of Hertz. Its approach is
# c²/R.
side = 320.0  # nm
loads = hard_wall.sphere_load(sizes, radius, contact_modulus)  # nN
scene = cs.Scene(
    cs.FreeHalfSpace(contact_modulus), cs.Sphere(side, radius), cs.HardWall(), cs.pressures(loads / side**2)
)
sphere_points = np.array([32, 64, 128, 256])
sphere_errors = []
for points in sphere_points:
    surface = cs.simulate(scene, points=int(points), tolerance=1e-7)
    sphere_errors.append(rms(surface.approach.values / (sizes**2 / radius) - 1))

# %%
# The order is the slope of the error on logarithmic axes.
middle = sizes.mean()
cylinder_steps, sphere_steps = period / cylinder_points / middle, side / sphere_points / middle


def order(steps, errors):
    """Return the order of convergence."""
    return np.polyfit(np.log(steps), np.log(errors), 1)[0]


orders = {
    "half-width, points counted": order(cylinder_steps, counted),
    "half-width, edges between points": order(cylinder_steps, cylinder_errors),
    "approach of the sphere": order(sphere_steps, sphere_errors),
}

# %%
# Beside the errors, the pressure of the sphere along its middle on a grid of 32 points.
x = (np.arange(32) - 16) * side / 32
heights = -(x**2 + x[:, None] ** 2) / (2 * radius)
pressed = cs.press(
    heights,
    spacing=side / 32,
    contact_modulus=contact_modulus,
    mean_pressure=hard_wall.sphere_load(100.0, radius, contact_modulus) / side**2,
    periodic=False,
)
fine = np.linspace(-side / 2, side / 2, 501)
exact = hard_wall.sphere_pressure(fine, 100.0, radius, contact_modulus)

figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 4.0), layout="constrained")
left.plot(fine, 1e3 * exact, "k", lw=1, label="Hertz")
left.plot(x, 1e3 * pressed.pressure[16], "^", color="C2", label="32 × 32 points")
left.set(xlabel="position x (nm)", ylabel="pressure of the sphere (MPa)", ylim=(-0.2, 9))
left.legend()
curves = [(cylinder_steps, counted), (cylinder_steps, cylinder_errors), (sphere_steps, sphere_errors)]
for (steps, errors), (name, slope), marker in zip(curves, orders.items(), "so^", strict=True):
    right.loglog(steps, errors, f"{marker}-", label=f"{name}: order {slope:.1f}")
right.set(xlabel="grid spacing over mean size of the contact, Δx/c", ylabel="rms relative error", ylim=(3e-8, 0.1))
right.legend(loc="lower right", fontsize="small")
print("order of convergence:", {name: round(float(slope), 1) for name, slope in orders.items()})
