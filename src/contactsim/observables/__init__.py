"""Numbers read off solutions: functions of arrays."""
