"""Scenes, load paths, and the problem that a scene poses."""
