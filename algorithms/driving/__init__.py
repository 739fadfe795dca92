"""Where to drive."""
