"""Curbs that turn away from the road: corners, side streets, islands, found in the plan."""
