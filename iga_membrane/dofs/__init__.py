"""Unknowns: how control points may move, and which numbers move them."""
