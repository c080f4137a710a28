"""The Lagrangian of a problem: energy and constraints with their derivatives by the unknowns."""
