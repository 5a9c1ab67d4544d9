"""
Contact stiffness and conductance
=================================

The stiffness of a contact is the rise of the mean pressure with the approach. By Barber's relation the conductance of
heat or current is proportional to it. The stiffness of a wavy line follows from Westergaard's answer, and that of rough
surfaces is nearly proportional to the pressure.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference import hard_wall

# %%
# A wavy line of amplitude h₀ and wavelength λ. The pressure of complete contact is p_c = π E* h₀/λ. The mean gap is
# h₀ (1 - r + r ln r) at r = p/p_c, so the stiffness is π E*/(λ ln(p_c/p)).
contact_modulus, wavelength, amplitude = 100.0, 1000.0, 10.0  # GPa, nm, nm
complete = hard_wall.full_contact_pressure(amplitude, wavelength, contact_modulus)  # GPa
ratios = np.array([0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9])
exact_stiffness = np.pi * contact_modulus / (wavelength * np.log(1 / ratios))  # GPa/nm
wave = cs.Sinusoid(length=wavelength, amplitude=amplitude)
scene = cs.Scene(cs.HalfSpace(contact_modulus), wave, cs.HardWall(), cs.pressures(ratios * complete))
data = cs.simulate(scene, points=4096, keep=["stiffness"], tolerance=1e-6)
stiffness = data.contact_stiffness.values
gap_error = np.abs(data.mean_gap / hard_wall.sinusoid_mean_gap(ratios, amplitude) - 1).max().item()
print("stiffness over the exact one:", (stiffness / exact_stiffness).round(4))
print(f"largest relative error of the mean gap: {gap_error:.1e}")

# %%
# A single result of ``press`` has a stiffness too.
pressed = cs.press(
    wave.heights(4096), spacing=wavelength / 4096, contact_modulus=contact_modulus, mean_pressure=0.1 * complete
)
print(f"at p = 0.1 p_c: {cs.contact_stiffness(pressed):.5f} GPa/nm, exact {exact_stiffness[2]:.5f} GPa/nm")

# %%
# Rough surfaces of two rms gradients, between steel and aluminium. With conductivities in W/(m K) and lengths in nm the
# conductance is in W/(m K nm), which is 1e9 W/(m² K).
conductivities = (50.0, 240.0)  # W/(m K)
pressures = np.geomspace(0.003, 1.0, 8)  # GPa
rough = {}
for rms_gradient in (0.05, 0.1):
    surface = cs.SelfAffine(
        length=4000.0,
        hurst_exponent=0.8,
        long_cutoff=1000.0,
        short_cutoff=62.5,
        rms_gradient=rms_gradient,
        dimensions=2,
        seed=2,
    )  # nm
    scene = cs.Scene(cs.HalfSpace(contact_modulus), surface, cs.HardWall(), cs.pressures(pressures))
    rough[rms_gradient] = cs.simulate(scene, points=256, keep=["stiffness"])

figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 3.7), layout="constrained")
fine = np.geomspace(0.005, 0.95, 200)
left.plot(fine, np.pi * contact_modulus / (wavelength * np.log(1 / fine)), "k-.", lw=1, label="exact")
left.plot(ratios, stiffness, "o", label="wavy line")
left.set(
    xscale="log",
    yscale="log",
    xlabel="pressure over that of complete contact, p/p$_c$",
    ylabel="contact stiffness (GPa/nm)",
)
left.legend()
for (rms_gradient, numbers), marker in zip(rough.items(), "os", strict=True):
    conductance = cs.conductance(numbers.contact_stiffness.values, contact_modulus, conductivities)  # W/(m K nm)
    middle.loglog(pressures, numbers.contact_stiffness, f"{marker}-", label=f"rms gradient {rms_gradient}")
    right.loglog(pressures, 1e3 * conductance, f"{marker}-", label=f"rms gradient {rms_gradient}")
middle.set(xlabel="mean pressure (GPa)", ylabel="contact stiffness (GPa/nm)")
right.set(xlabel="mean pressure (GPa)", ylabel="contact conductance (MW/(m² K))")
middle.legend()
