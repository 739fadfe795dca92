"""Profiles across the road, and the steps, corners and chains that are found in them."""
