"""For the design office: 3D polylines as DXF, alignments of fitted elements as LandXML.

In: `RoadMapSource`. Out: a file.
"""

from ....core.lazy import public

__getattr__, __all__ = public(__name__, {
    "dxf": ("dxf_lines", "write_dxf"),
    "landxml": ("Alignment", "alignments_of", "landxml_text"),
})
