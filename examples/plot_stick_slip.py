"""
Stick-slip of springs on a lattice
==================================

A flat elastic layer slides over a rigid flat. Springs join the sites of both lattices. A soft layer sticks and slips, a
stiff one slides smoothly. All points move alike, so one equation gives the exact force, slips included.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference import springs

# %%
# Each spring is a mixed-mode cohesive zone with tangential work φt = 0.2 N/m and length 1 nm. The layer is sheared
# through its thickness h, so its stiffness is G/h.
thickness, poisson_ratio, lattice_constant = 500.0, 0.45, 2.5  # nm, –, nm
law = cs.CohesiveZone(work_of_separation=2.0, work_ratio=0.1)  # N/m
length = 100.0  # nm, period of both flats


def slide(youngs_modulus):
    """Return slides (nm) and shear tractions (GPa) of a layer with a Young's modulus in GPa."""
    layer = cs.Layer(youngs_modulus / (1 - poisson_ratio**2), poisson_ratio, thickness)
    upper, lower = cs.Body(cs.Flat(length), layer), cs.Body(cs.Flat(length))  # a body without elasticity is rigid
    press = cs.approaches([-10.0, 0.0], 1.0, from_touch=True)
    path = press >> cs.sliding([0.0, 12.0], 0.1, approach=0.0, from_touch=True)
    scene = cs.Scene(lower, upper, law, path, cs.Lattice(lattice_constant))
    data = cs.simulate(scene, points=8, tolerance=1e-6)
    assert (data.status == 0).all()
    sliding = data.isel(step=np.isfinite(data.sliding_distance))  # without the steps that press
    return sliding.sliding_distance.values, sliding.friction_force.values / length, data


# %%
# The layer slips where the springs soften faster than the layer is stiff: below a critical modulus.
shear_strength = law.work_of_separation * law.work_ratio / law.tangential_length  # GPa, φt/δt
steepest = shear_strength / law.tangential_length * springs.steepest_fall(lattice_constant, law.tangential_length)
critical_modulus = steepest * thickness * 2 * (1 + poisson_ratio)  # GPa
print(f"critical Young's modulus: {critical_modulus:.0f} GPa")

moduli = [40.0, 140.0, 600.0]  # GPa
computed, exact, slips = {}, {}, {}
for modulus in moduli:
    slides, tractions, data = slide(modulus)
    stiffness = modulus / (2 * (1 + poisson_ratio)) / thickness  # GPa/nm
    computed[modulus] = tractions
    exact[modulus] = springs.uniform_slide(slides, stiffness, shear_strength, lattice_constant)
    slips[modulus] = int(data.event_slip.notnull().sum())  # without slips there is one event, without numbers
    print(f"E = {modulus:g} GPa: {slips[modulus]} slips, mean traction {1e3 * tractions.mean():.1f} MPa")

figure, axes = plt.subplots(figsize=(7.5, 3.8), layout="constrained")
for modulus, marker in zip(moduli, "os^", strict=True):
    (line,) = axes.plot(slides, 1e3 * exact[modulus], lw=1)
    axes.plot(slides, 1e3 * computed[modulus], marker, ms=3.5, color=line.get_color(), label=f"E = {modulus:g} GPa")
axes.plot([], [], "k", lw=1, label="exact")
axes.axhline(0, color="k", lw=0.5)
axes.set(xlabel="sliding distance (nm)", ylabel="shear traction (MPa)", ylim=(None, 260))
axes.legend(ncols=4, loc="upper center")
