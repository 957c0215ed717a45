"""Measures of a drawing: spacing, spectrum, tone error."""
