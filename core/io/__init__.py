"""File formats and coordinate systems that several folders use.

In: text tables, tiled GeoTIFFs, CRS definitions. Out: arrays with their metadata, checked; images are written whole or not at all.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "IntensityImage": "geotiff",
    "NumberTable": "text_table",
    "check_metric": "crs",
    "check_projected": "crs",
    "crs_note": "crs",
    "filled_tiles": "geotiff",
    "gdal_exceptions": "gdal_errors",
    "horizontal_part": "crs",
    "new_geotiff": "geotiff",
    "parse_crs": "crs",
    "read_number_table": "text_table",
    "same_crs": "crs",
    "write_display_image": "geotiff",
})
