"""Source code of modules, read as what it computes."""
