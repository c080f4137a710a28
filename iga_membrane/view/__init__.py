"""Ways to look at a solution: result file, state file, picture, VTU."""
