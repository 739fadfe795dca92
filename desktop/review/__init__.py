"""Going through a finished map: doubtful places one after the other, cross-sections through the points, and corrections."""
