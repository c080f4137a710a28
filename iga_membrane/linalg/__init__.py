"""Linear algebra: systems with borders, and how many of their eigenvalues are negative."""
