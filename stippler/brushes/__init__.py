"""Brushes: tips, strokes and effects, without a window; one module a family of effects."""
