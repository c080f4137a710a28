"""Solving: what changes the unknowns."""
