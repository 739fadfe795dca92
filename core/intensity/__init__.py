"""What asphalt and paint return to the scanner.

In: road points. Out: intensities freed of range and incidence, and the geo-referenced intensity image.
"""
