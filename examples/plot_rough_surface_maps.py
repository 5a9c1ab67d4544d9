"""
Pressure and gap of a rough surface
===================================

A self-affine surface is pressed on a half-space. The maps show the pressure in contact and the gap beside it. The
pressures in contact are compared with Persson's theory, and the gap is computed once more from the pressure with numpy.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference.persson import persson_pressure_density

# %%
# A surface of 1 µm × 1 µm with waves from 500 nm to 16 nm. ``press`` takes the heights and one load.
length, points, contact_modulus = 1000.0, 512, 1.0  # nm, GPa
rms_gradient, reduced_pressure = 0.1, 0.1
surface = cs.SelfAffine(
    length=length,
    hurst_exponent=0.8,
    long_cutoff=500.0,
    short_cutoff=16.0,
    rms_gradient=rms_gradient,
    dimensions=2,
    seed=4,
)  # nm
heights = surface.heights(points)
mean_pressure = reduced_pressure * contact_modulus * rms_gradient  # GPa
result = cs.press(
    heights, spacing=length / points, contact_modulus=contact_modulus, mean_pressure=mean_pressure, tolerance=1e-5
)
print(result.status.sentence)
print("relative contact area:", round(result.relative_contact_area, 3))

# %%
# A check by numpy alone. On a periodic half-space a wave of pressure with wavenumber q is divided by E* q/2 to give the
# displacement. The gap is displacement minus height minus approach.
q = 2 * np.pi * np.fft.fftfreq(points, length / points)
q = np.hypot(q, q[:, None])
q[0, 0] = np.inf  # the mean displacement is zero by convention
displacement = np.fft.ifft2(np.fft.fft2(result.pressure) * 2 / (contact_modulus * q)).real
gap = displacement - heights - result.approach  # nm
gap_in_contact, overlap = np.abs(gap[result.contact]).max(), -gap.min()
print(f"gap by numpy: in contact at most {gap_in_contact:.1e} nm, overlap at most {overlap:.1e} nm")

# %%
# The density of pressure is over the whole area, so its integral is the relative contact area.
share, edges = np.histogram(1e3 * result.pressure[result.contact], bins=40)  # MPa
density = share / points**2 / np.diff(edges)
places = np.linspace(0, edges[-1], 200)
theory = persson_pressure_density(places / 1e3, mean_pressure, contact_modulus, rms_gradient) / 1e3

figure, axes = plt.subplots(1, 3, figsize=(12, 3.6), layout="constrained", width_ratios=[1, 1, 0.9])
extent = (0, length, 0, length)
pressure = np.ma.masked_where(~result.contact, 1e3 * result.pressure)
image = axes[0].imshow(pressure, origin="lower", extent=extent, cmap="inferno_r")
figure.colorbar(image, ax=axes[0], label="pressure (MPa)")
image = axes[1].imshow(gap, origin="lower", extent=extent, cmap="Blues_r")
axes[1].contour(result.contact, [0.5], origin="lower", extent=extent, colors="C3", linewidths=0.4)
figure.colorbar(image, ax=axes[1], label="gap (nm)")
for panel in axes[:2]:
    panel.set(xlabel="x (nm)", ylabel="y (nm)")
axes[2].stairs(density, edges, fill=True, alpha=0.5, label="simulated")
axes[2].plot(places, theory, "k-.", lw=1, label="Persson")
axes[2].set(xlabel="pressure in contact (MPa)", ylabel="density over the whole area (1/MPa)")
axes[2].legend()
