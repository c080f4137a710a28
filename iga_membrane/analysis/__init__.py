"""Questions asked of solutions: at which value of a parameter something happens."""
