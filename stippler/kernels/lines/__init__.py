"""Dots and lines: the nearest line, distances kept, even spacing in one dimension."""
