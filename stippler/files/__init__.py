"""Reading pictures and writing drawings."""
