"""UAV images below the road map."""
