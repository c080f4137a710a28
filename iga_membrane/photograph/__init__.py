"""Photographs of droplets: their outlines, and the profiles of Young and Laplace through them."""
