"""Identification: judge the statements on the probe of Chapter 6 over the parameters that the text leaves open."""
