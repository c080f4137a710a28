"""Scenes: what is asked, as data."""
