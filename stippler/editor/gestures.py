"""What the mouse does on the canvas, as the shortcut sheet tells it."""

from __future__ import annotations

GESTURES = (
    ("Move the page", "Middle button, or Space and drag"),
    ("Turn the page", "Shift with either of these"),
    ("Zoom at the pointer", "Wheel"),
    ("A lens for a moment", "Hold its key"),
    ("Strength of the lens", "Hold its key and wheel"),
    ("Size of the tip", "Shift and drag"),
    ("Size of the tip, in steps", "Ctrl or Alt and wheel"),
    ("Straight line from the last stroke", "Shift and click"),
    ("Light pressure, where the brush asks for it", "Alt"),
    ("Add to the selection", "Shift while selecting"),
    ("Take from the selection", "Alt while selecting"),
    ("Move the selection", "Drag anywhere within it"),
    ("Scale or turn the selection", "Drag a corner, or the handle above"),
    ("Invert a brush", "Ctrl while pressing"),
    ("Tools, size, undo", "Right button"),
    ("Open a menu", "F10, or Alt and its letter"),
    ("Close a polygon", "Enter or double click"),
    ("Take back a stroke that goes on", "Esc"),
    ("Type a slider's number", "Ctrl and click"),
    ("Open a picture", "Drop it on the window"),
)
"""What it is for, and how it is done."""
