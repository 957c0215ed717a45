"""Stippler: an editor for stipple drawings, and the methods behind it."""
__version__ = "0.1.0"
