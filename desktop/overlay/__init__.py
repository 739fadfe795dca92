"""Windows for images below the road map."""
