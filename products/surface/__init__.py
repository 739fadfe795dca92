"""The surface of the road for design: breaklines, and a triangulation of the ground thinned to a tolerance.

In: an open `Survey` and the layers of its road map. Out: a `SurfaceModel`, its layers, its raster of heights; `cad` writes it as LandXML and DXF.
"""
