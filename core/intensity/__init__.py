"""What asphalt and paint return to the scanner.

In: road points. Out: intensities without the effect of range and incidence, and the geo-referenced intensity image.
"""
