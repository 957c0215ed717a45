"""The page in the window: the drawing, what lies over it, and the lens."""
