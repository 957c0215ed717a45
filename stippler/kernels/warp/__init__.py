"""Smooth deformation of points: perspective, a cage of control points, pins."""
