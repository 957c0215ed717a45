"""Drawings to files, one module a kind."""
