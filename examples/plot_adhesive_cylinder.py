"""
Adhesive cylinder, pressed and pulled off
=========================================

A cylinder with adhesion is pressed on a half-space and pulled off again. It jumps into contact and out of contact, at
different approaches, so the cycle dissipates energy. Adhesion is short-ranged here, and the pull-off load and the size
of the contact are those of JKR for cylinders.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs
from contactsim.reference import adhesion, hard_wall

# %%
# The cohesive zone pulls up to a gap of some normal lengths. The path has three turning points: it presses to 8 nm and
# pulls back to -16 nm, in steps of 0.1 nm.
radius, contact_modulus, work = 1e4, 1.0, 0.05  # nm, GPa, N/m
law = cs.NormalCohesiveZone(work_of_separation=work, normal_length=0.5)  # N/m, nm
bodies = cs.HalfSpace(contact_modulus), cs.Cylinder(length=8000.0, radius=radius)
cycle = cs.Scene(*bodies, law, cs.approaches([-9.0, 8.0, -16.0], 0.1))  # nm
data = cs.simulate(cycle, points=2048, tolerance=1e-5)
assert (data.status == 0).all()

# %%
# Jumps are listed as folds: load and approach before and after. The energy that the cycle dissipates is the area of the
# loop, of which each jump closes one side.
for fold in range(data.sizes["fold"]):
    at = data.isel(fold=fold)
    print(
        f"jump at {at.fold_approach_before:.2f} nm: load from {at.fold_load_before:.2f} to {at.fold_load_after:.2f} N/m"
    )
pull_off = -data.line_load.min().item()
exact_pull_off = float(adhesion.cylinder_pull_off(work, radius, contact_modulus))
dissipated = np.trapezoid(data.line_load, data.approach)
print(f"pull-off {pull_off:.3f} N/m, JKR {exact_pull_off:.3f} N/m; dissipated {dissipated:.2f} nJ/m")

# %%
# In JKR the contact is a crack that opens at its edges. The traction is largest there, where the gap is one normal
# length. The exact load follows from the half-width. At the ``snapshots`` the gap at each point is kept.
kept = [8.0, 4.0, 0.0, -4.0, -7.0, -9.0, -9.7]
pulled = cs.simulate(cs.Scene(*bodies, law, cs.approaches(kept)), points=2048, tolerance=1e-5, snapshots=kept)
loads = pulled.line_load.values
half_widths = []
for gap in pulled.normal_gap.values - law.normal_length:
    (left_edge, right_edge) = np.flatnonzero(np.diff(gap < 0))  # the points before the two edges
    places = [at + gap[at] / (gap[at] - gap[at + 1]) for at in (left_edge, right_edge)]
    half_widths.append(np.ptp(places) * pulled.length.item() / gap.size / 2)
half_widths = np.array(half_widths)


def jkr_load(half_width):
    """Return Hertz's load less that of the crack, N/m."""
    crack = np.sqrt(2 * np.pi * contact_modulus * work * half_width)
    return hard_wall.cylinder_load(half_width, radius, contact_modulus) - crack


figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 3.8), layout="constrained")
turn = int(data.approach.values.argmax())
left.plot(data.approach[: turn + 1], data.line_load[: turn + 1], ".-", ms=3, label="pressed")
left.plot(data.approach[turn:], data.line_load[turn:], ".-", ms=3, label="pulled off")
left.axhline(-exact_pull_off, color="k", ls="-.", lw=1, label="pull-off by JKR")
left.set(xlabel="approach (nm)", ylabel="load (N/m)")
left.legend()
sizes = np.linspace(1.0, 440.0, 200)
right.plot(sizes, jkr_load(sizes), "k-.", lw=1, label="JKR")
right.plot(half_widths, loads, "o", label="simulated")
right.set(xlabel="half-width of the contact (nm)", ylabel="load (N/m)")
right.legend()
