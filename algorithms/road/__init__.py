"""Where the road is."""
