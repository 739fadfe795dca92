"""UAV images.

In: an image and ground control points. Out: a polynomial, its residuals, and the image drawn on the map.
"""
