"""What is painted.

In: road points and the intensity image. Out: markings as polygons (`paint`, then `objects`) and marking lines (`lines`).
"""
