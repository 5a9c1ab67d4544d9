"""From one load step to the next."""
