"""Every figure the documents promise, measured."""

import os

os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # programs start as a person's do, compiled before
