"""Solvers: what changes the unknowns until forces vanish."""
