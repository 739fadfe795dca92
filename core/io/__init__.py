"""File formats and coordinate systems that several folders use.

In: text tables, tiled GeoTIFFs, CRS definitions. Out: arrays with their metadata, checked; images are written whole or not at all.
"""
