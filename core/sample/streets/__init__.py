"""Simulated streets that follow one axis: their scenes, and how pulses meet their ground.

In: length, seed, radius, curb height and gutter. Out: a `Scene` (see ../street.py).
"""
