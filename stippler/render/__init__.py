"""One class for each GL pass, and their order."""
