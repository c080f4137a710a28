"""Drivers: a question to its answer, through solvers, evidence and the ways round a failure."""
