"""Elastic bodies: displacement from traction."""
