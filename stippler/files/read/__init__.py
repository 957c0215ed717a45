"""Files in: pictures of every kind, and tables of dots."""
