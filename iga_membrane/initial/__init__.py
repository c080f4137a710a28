"""Starts: shapes near equilibrium, and meshes that are fine where they must be."""
