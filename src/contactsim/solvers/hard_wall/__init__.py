"""Solvers of contact with a hard wall."""
