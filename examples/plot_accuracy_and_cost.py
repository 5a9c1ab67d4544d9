"""
What an accuracy costs
======================

One scene is simulated to an accuracy of 5, 1 and 0.2 % of its contact area. Grid and tolerance follow from the
accuracy. The true error is the difference from a much finer grid, and the cost is counted in transforms.
"""

import matplotlib.pyplot as plt
import numpy as np

import contactsim as cs

# %%
# A rough line at three pressures. ``estimate_cost`` tells grid and transforms before anything runs.
line = cs.SelfAffine(
    length=1e4, hurst_exponent=0.8, long_cutoff=2500.0, short_cutoff=40.0, rms_gradient=0.1, seed=1
)  # nm
scene = cs.Scene(cs.HalfSpace(contact_modulus=1.0), line, cs.HardWall(), cs.pressures([0.001, 0.003, 0.01]))  # GPa
accuracies = np.array([0.05, 0.01, 0.002])
for accuracy in accuracies:
    forecast = cs.estimate_cost(scene, accuracy=accuracy)
    print(f"{accuracy:.1%}: forecast of {forecast.points} points and {forecast.transforms:.0f} transforms of them")

# %%
# The dataset holds the estimated error of the area at each load. ``transforms`` counts the transforms of each load,
# ``coarse_run_transforms`` those of the coarser grid on which the error was estimated.
runs = [cs.simulate(scene, accuracy=accuracy) for accuracy in accuracies]
area = "relative_contact_area_subgrid"
estimated_errors = np.array([float((run[f"{area}_estimated_error"] / run[area]).max()) for run in runs])
points = np.array([int(run.points.max()) for run in runs])
transforms = np.array([float(run.transforms.sum() + run.coarse_run_transforms.max()) for run in runs])
work = transforms * points / 4096  # of transforms of 4096 points

# %%
# The reference has sixteen times the points of the finest run.
reference = cs.simulate(scene, points=16 * int(points.max()), tolerance=1e-6)
true_errors = np.array([float(abs(run[area] / reference[area] - 1).max()) for run in runs])
for row in zip(accuracies, points, work, estimated_errors, true_errors, strict=True):
    print("{:.1%}: {} points, {:.0f} transforms of 4096 points, error {:.2%} estimated, {:.2%} true".format(*row))

# %%
# The largest error of the three loads stays below the accuracy.
figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 3.8), layout="constrained")
ends = np.array([1e-3, 0.1])
left.loglog(ends, ends, "k:", lw=1, label="accuracy asked for")
left.loglog(accuracies, estimated_errors, "o", label="estimated error")
left.loglog(accuracies, true_errors, "s", label="true error")
left.set(xlabel="accuracy asked for", ylabel="largest relative error of the area")
left.legend()
right.loglog(accuracies, work, "o-")
for accuracy, size, cost in zip(accuracies, points, work, strict=True):
    right.annotate(f"{size} points", (accuracy, cost), (6, 6), textcoords="offset points")
right.set(xlabel="accuracy asked for", ylabel="cost (transforms of 4096 points)", xlim=(1e-3, 0.3), ylim=(10, 1000))
