"""Surfaces: position, its exact derivatives, and how control points may move."""
