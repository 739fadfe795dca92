"""UAV images, georeferenced with ground control points.

Control points are given, or proposed from paint that the intensity image shows too.

In: an image and ground control points. Out: a polynomial, its residuals, and the image resampled onto the map.
"""
