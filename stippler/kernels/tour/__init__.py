"""Short ways through many points."""
