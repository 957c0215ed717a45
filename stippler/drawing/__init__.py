"""Dots, areas, lines, style, edits and history: plain data, no threads, no GL."""
