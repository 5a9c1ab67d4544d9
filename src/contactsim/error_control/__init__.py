"""Grids, tolerances and increments from a wanted error; effects that may be neglected."""
