"""Scaling relations of error and cost: measured, fitted, validated."""
