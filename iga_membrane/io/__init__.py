"""Scene files: text to problems, by declarations that check it."""
