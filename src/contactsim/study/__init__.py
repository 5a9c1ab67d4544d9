"""From the config to scenes, runs and the plan of the workflow."""
