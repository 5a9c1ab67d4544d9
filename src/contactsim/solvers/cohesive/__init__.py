"""Solvers of contact with smooth laws."""
