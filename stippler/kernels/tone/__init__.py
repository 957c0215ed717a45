"""Ink: what cells ask for, what dots lay down, and their union."""
