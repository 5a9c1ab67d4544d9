"""
Adhesive sphere between DMT and JKR
===================================

An adhesive sphere is pulled off a half-space, for attractions of longer and shorter range but of the same work. The
pull-off goes from that of DMT, 2πwR, to that of JKR, 3πwR/2. Maugis's model is exact for Dugdale's attraction, which is
constant up to its range. The exponential cohesive zone pulls up to 5 % more.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference import adhesive_sphere

# %%
# Maugis's parameter λ tells which limit holds. It is proportional to the strength σ of the attraction. The range is w/σ
# for Dugdale's attraction, and the length of the exponential law is w/(eσ).
contact_modulus, work, radius = 1.0, 0.1, 1e4  # GPa, N/m, nm
sphere = {"work": work, "radius": radius, "contact_modulus": contact_modulus}
parameter_of_one_gpa = adhesive_sphere.maugis_parameter(**sphere, strength=1.0)


def pull(effects, side, points, approaches):
    """Return the forces (nN) at approaches (nm), of a sphere that is alone."""
    body, surface = cs.FreeHalfSpace(contact_modulus), cs.Sphere(length=side, radius=radius)
    scene = cs.Scene(body, surface, effects, cs.approaches(approaches))
    data = cs.simulate(scene, points=points, tolerance=1e-4)
    assert (data.status == 0).all()
    return data.normal_force.values


# %%
# The exponential law. A short range needs a finer grid, and a smaller part of the sphere is enough.
exponential = {}
approaches = [-2.5, -3.0, -3.5, -4.0, -4.5, -5.0, -6.0]  # nm
grids = {0.2: (3600.0, 64), 0.5: (2200.0, 64), 1.0: (1700.0, 64), 2.0: (880.0, 72), 3.0: (720.0, 128)}
for parameter, (side, points) in grids.items():
    strength = parameter / parameter_of_one_gpa  # GPa
    law = cs.NormalCohesiveZone(work_of_separation=work, normal_length=work / (np.e * strength))
    exponential[parameter] = -pull(law, side, points, approaches).min()

# %%
# Dugdale's attraction acts beside a hard wall. Maugis's curve ends where the wall no longer touches; the attraction
# alone pulls beyond.
dugdale, curves = {}, {}
approaches = np.arange(5.0, -6.5, -1.0)  # nm
for parameter, side in ((0.2, 3600.0), (0.5, 2200.0)):
    strength = parameter / parameter_of_one_gpa
    law = cs.DugdaleAttraction(work_of_separation=work, normal_length=work / strength)
    curves[parameter] = pull((cs.HardWall(), law), side, 64, approaches)
    dugdale[parameter] = -curves[parameter].min()

# %%
# Exact answers and a figure.
dmt, jkr = adhesive_sphere.dmt_pull_off(work, radius), adhesive_sphere.jkr_pull_off(work, radius)
parameters = np.geomspace(0.05, 10.0, 60)
maugis = [adhesive_sphere.maugis_pull_off(**sphere, strength=value / parameter_of_one_gpa) for value in parameters]
exact = {
    value: adhesive_sphere.maugis_pull_off(**sphere, strength=value / parameter_of_one_gpa) for value in exponential
}

figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 3.8), layout="constrained")
for (parameter, forces), colour in zip(curves.items(), ("C0", "C1"), strict=True):
    _, force, approach = adhesive_sphere.maugis_states(**sphere, strength=parameter / parameter_of_one_gpa)
    left.plot(approach, force, color=colour, lw=1, label=f"Maugis, λ = {parameter}")
    left.plot(approaches, forces, "o", ms=4, color=colour, label=f"simulated, λ = {parameter}")
left.set(xlabel="approach (nm)", ylabel="force (nN)", xlim=(-8, 5.5), ylim=(-6500, -500))
left.legend()
right.plot(parameters, np.array(maugis) / (np.pi * work * radius), "k-.", lw=1, label="Maugis")
for pulls, marker, label in ((exponential, "s", "exponential law"), (dugdale, "o", "Dugdale's attraction")):
    values = np.array(list(pulls.values())) / (np.pi * work * radius)
    right.plot(list(pulls), values, marker, label=label)
right.axhline(2.0, color="C7", ls=":")
right.axhline(1.5, color="C7", ls=":")
right.text(0.055, 2.01, "DMT", va="bottom")
right.text(0.055, 1.51, "JKR", va="bottom")
right.set(xscale="log", xlabel="Maugis's parameter λ", ylabel="pull-off / (πwR)", ylim=(1.45, 2.1))
right.legend()
for parameter, value in exponential.items():
    print(f"λ = {parameter}: {value:.0f} nN, {value / exact[parameter]:.3f} of Maugis's")
