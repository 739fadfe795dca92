"""File formats and coordinate systems that several folders use.

In: text tables, tiled GeoTIFFs, CRS definitions. Out: arrays with their metadata, checked; images are written whole or not at all.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "crs": ("check_metric", "check_projected", "check_same_crs", "crs_note", "horizontal_part", "parse_crs", "same_crs", "unit_note"),
    "gdal_errors": ("gdal_exceptions",),
    "geotiff": ("IntensityImage", "filled_tiles", "new_geotiff", "write_display_image"),
    "text_table": ("NumberTable", "read_number_table"),
    "local_files": ("check_local", "offline", "open_raster", "open_vector"),
    "unfinished": ("finish_file", "unfinished_path"),
})
