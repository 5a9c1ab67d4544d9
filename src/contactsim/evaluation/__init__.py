"""The package measured: cost, robustness, calibration."""
