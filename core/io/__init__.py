"""File formats and coordinate systems that several folders use.

In: text tables, tiled GeoTIFFs, CRS definitions. Out: arrays with their metadata, checked; images are written whole or not at all.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "crs": (
        "FileUnits", "as_in_file", "check_metric", "check_place", "check_projected", "check_same_crs", "crs_name", "crs_note",
        "horizontal_part", "in_metres", "moved_by", "parse_crs", "place_of_raster", "place_on_ground", "place_raster", "plane_wkt",
        "same_crs", "unit_names", "unit_note"),
    "geotiff": ("IntensityImage", "filled_tiles", "new_geotiff", "write_display_image"),
    "local_files": ("check_local", "finish_file", "gdal_exceptions", "offline", "open_raster", "open_vector", "unfinished_path"),
    "text_table": ("NumberTable", "read_number_table"),
})
