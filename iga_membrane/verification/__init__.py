"""Evidence that a state is right, gathered on paths that its computation did not take."""
