"""Every figure the documents promise, measured."""
