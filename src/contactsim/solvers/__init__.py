"""Solvers: none names a law or a body."""
