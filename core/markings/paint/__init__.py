"""Paint separated from asphalt.

In: road points and the intensity image. Out: the points and the pixels that are paint.
"""
