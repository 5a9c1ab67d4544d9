"""Figures about the package: accuracy, cost, robustness."""
