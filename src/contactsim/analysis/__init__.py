"""Datasets of studies: aggregation, statistics, fits and claims."""
