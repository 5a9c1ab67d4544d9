"""Report, gallery and bundle of all results."""
