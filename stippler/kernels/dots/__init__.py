"""Grids that dots are found in, and bringing results back to them."""
