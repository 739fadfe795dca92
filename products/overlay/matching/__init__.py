"""Control points proposed: the same paint found in a photo and in the intensity image.

In: an image that lies roughly, and the intensity image. Out: pairs of places, each with the likeness of its two cut-outs.
"""
