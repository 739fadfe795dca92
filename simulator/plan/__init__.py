"""Simulated roads laid out in the plane: junctions, rings and hairpins, which no single axis describes.

In: length, seed and curb height. Out: a `PlanScene` for the scanners, with its truth.

The ground is a terrain of gentle slopes (heights on a grid); the carriageway is an area of it, and beyond its edges strips rise or
fall: curb, sidewalk, verge. Paint is polygons, objects stand on the ground, and each pass follows a path.
"""
