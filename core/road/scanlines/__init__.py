"""Normalized scanlines: the scan lattice as a mesh, cut by planes, and the curbs and boundaries found on them."""
