"""The worker thread, its frozen requests and its results."""
