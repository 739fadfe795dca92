"""Simulated streets that follow one axis.

In: length, seed, radius, curb height and gutter. Out: a `Scene` for the scanners, with its truth.
"""
