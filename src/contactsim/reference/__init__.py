"""Exact answers, for tests and figures alike.

Loads are per unit thickness; units nm, GPa, N/m, in which E* times a length is a line load without further factors.
"""
