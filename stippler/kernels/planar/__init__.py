"""Exact geometry on a grid: borders that meet, faces between them, whose place a point is."""
