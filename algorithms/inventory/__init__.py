"""What else the road shows."""
