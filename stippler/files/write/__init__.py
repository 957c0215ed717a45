"""Drawings to files: one module a format, all made from the same sheet of layers."""
