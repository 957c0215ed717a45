"""Outlines of dots: on the screen, and as text."""
