"""Windows over the canvas that take the keyboard: dialogs, palette, preferences."""
