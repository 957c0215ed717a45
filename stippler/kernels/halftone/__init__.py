"""Pulse-density modulation: regions, and the order they grow in."""
