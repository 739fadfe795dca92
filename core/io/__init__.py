"""Formats that several folders read or write: tables of numbers, coordinate reference systems, tiled GeoTIFFs."""
