"""Shapes, random roughness and measured heights: no mechanics."""
