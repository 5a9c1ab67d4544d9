"""Measure the area that counting points in contact adds at the edges of a sphere's contact: EDGE_EXCESS of a surface.

Usage: python benchmarks/edge_excess.py [SPHERES]
"""

from __future__ import annotations

import sys

import numpy as np

import contactsim as cs
from contactsim.observables.contact import contact_edges, touching

POINTS = 1024
RADIUS = 1e6
SMALLEST, LARGEST = 5, 40
"""Contact radii, in points: at most a 25th of the period, where neighbours change the contact by less than 2e-4."""


def edge_excess(contact_radius: float, offset: np.ndarray) -> float:
    """Return the cells counted beyond the area of a Hertzian contact, for each pair of neighbours at its edge."""
    along = np.arange(POINTS) - POINTS // 2
    heights = -((along[:, None] - offset[0]) ** 2 + (along - offset[1]) ** 2) / (2 * RADIUS)
    pressure = 4 / 3 * contact_radius**3 / RADIUS / POINTS**2
    result = cs.press(heights, spacing=1.0, contact_modulus=1.0, mean_pressure=pressure, tolerance=1e-4)
    contact = touching(np.asarray(result.pressure))
    return (np.count_nonzero(contact) - np.pi * contact_radius**2) / contact_edges(contact)


def main() -> None:
    """Print the mean excess with its standard error, for all spheres and by the size of the contact."""
    spheres = int(sys.argv[1]) if len(sys.argv) > 1 else 600
    generator = np.random.default_rng(6)
    radii = generator.uniform(SMALLEST, LARGEST, spheres)
    excess = np.array([edge_excess(radius, generator.uniform(-0.5, 0.5, 2)) for radius in radii])
    for low, high in ((SMALLEST, 10), (10, 20), (20, LARGEST), (SMALLEST, LARGEST)):
        part = excess[(radii >= low) & (radii <= high)]
        error = part.std(ddof=1) / np.sqrt(part.size)
        print(f"{low} to {high} points: {part.mean():.4f} ± {error:.4f} of {part.size} spheres")


if __name__ == "__main__":
    main()
