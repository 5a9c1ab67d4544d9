"""
A law of your own
=================

A Morse potential acts between a sphere and a stiff half-space. The law is one class with its traction, slope and
energy. The force on a rigid sphere is 2πR times the energy of the law, by Derjaguin, so the pull-off of every law is
2πwR.
"""

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs

# %%
# The gap has shape (1, n), so do the tractions. A traction is positive where it pulls the bodies together. The class
# takes its parameters from ``NormalCohesiveZone``: w is ``work_of_separation`` and ℓ is ``normal_length``.


@dataclass(frozen=True)
class Morse(cs.NormalCohesiveZone):
    """Energy w (exp(-2g/ℓ) - 2 exp(-g/ℓ)) of the gap g."""

    @property
    def strength(self):
        """Largest traction, GPa: tolerances are measured in it."""
        return self.work_of_separation / self.normal_length / 2

    def _parts(self, gap):
        """Return exp(-g/ℓ) and its square; an overlap of more than 3ℓ, which does not occur here, is cut off."""
        near = np.exp(-np.maximum(gap / self.normal_length, -3.0))
        return near, near**2

    def energy(self, gap):
        """Return the energy (n,), N/m."""
        near, far = self._parts(gap[0])
        return self.work_of_separation * (far - 2 * near)

    def traction(self, gap):
        """Return the traction (1, n), GPa."""
        near, far = self._parts(gap)
        return 2 * self.work_of_separation / self.normal_length * (near - far)

    def tangent(self, gap):
        """Return the traction (1, n), GPa, and its slope (1, 1, n), GPa/nm."""
        near, far = self._parts(gap)
        slope = 2 * self.work_of_separation / self.normal_length**2 * (2 * far - near)
        return self.traction(gap), slope[None]


# %%
# A check before any simulation: traction and slope are the derivatives of energy and traction.
morse = Morse(work_of_separation=0.1, normal_length=1.0)  # N/m, nm
gaps, step = np.linspace(-1.0, 8.0, 400)[None], 1e-5
slope_of_energy = (morse.energy(gaps + step) - morse.energy(gaps - step)) / (2 * step)
slope_of_traction = (morse.traction(gaps + step) - morse.traction(gaps - step))[0] / (2 * step)
derivative_error = max(
    np.abs(morse.traction(gaps)[0] - slope_of_energy).max(),
    np.abs(morse.tangent(gaps)[1][0, 0] - slope_of_traction).max(),
)
print(f"largest error of the derivatives: {derivative_error:.0e}")

# %%
# The sphere is pulled off a half-space that is as stiff as diamond. The exponential law of the package is beside it.
radius, work = 1000.0, morse.work_of_separation  # nm, N/m
approaches = np.arange(0.2, -6.0, -0.2)  # nm
laws = {"Morse": morse, "exponential": cs.NormalCohesiveZone(work_of_separation=work, normal_length=1.0)}
forces = {}
for name, law in laws.items():
    scene = cs.Scene(
        cs.FreeHalfSpace(contact_modulus=1000.0), cs.Sphere(length=400.0, radius=radius), law, cs.approaches(approaches)
    )
    data = cs.simulate(scene, points=64, tolerance=1e-6)
    assert (data.status == 0).all()
    forces[name] = data.normal_force.values  # nN, compression positive
    print(f"{name}: pull-off {-forces[name].min():.1f} nN, 2πwR = {2 * np.pi * work * radius:.1f} nN")

figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 3.8), layout="constrained")
for (name, law), colour in zip(laws.items(), ("C0", "C1"), strict=True):
    left.plot(gaps[0], 1e3 * law.traction(gaps)[0], color=colour, label=name)
    derjaguin = 2 * np.pi * radius * law.energy(-approaches[None])
    right.plot(-approaches, derjaguin, color=colour, lw=1, label=f"{name}: Derjaguin")
    right.plot(-approaches, forces[name], "o", ms=4, color=colour, label=f"{name}: simulated")
left.set(xlabel="gap (nm)", ylabel="traction, pull positive (MPa)", ylim=(-150, 60))
left.axhline(0, color="k", lw=0.5)
left.legend()
right.axhline(-2 * np.pi * work * radius, color="k", ls="-.", lw=1, label="-2πwR")
right.set(xlabel="minus the approach (nm)", ylabel="force (nN)")
right.legend(loc="center right", bbox_to_anchor=(1, 0.35))
