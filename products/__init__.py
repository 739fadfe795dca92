"""What is made of a road map or judged about it; each room uses the public names of `core` alone.

`inventory` measures what else the road shows, `surface` makes its ground for design, `cloud` gives the points back with what the map knows of
them, `export` writes, reads and checks HD maps, `overlay` lays UAV images under the map, `assess` compares a map with a reference, `report` writes
the HTML pages. One file each: `cad` (DXF and LandXML), `inspection` (what the files of a survey hold), `scanline_layer` (normalized scanlines as
lines and evenly spaced points), `published_markings` (two published methods to compare ours with).
"""
