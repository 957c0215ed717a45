"""Voronoi cells clipped to their compartments: search, cutting, integrals, relaxation."""
