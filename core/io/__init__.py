"""File formats and coordinate systems that several folders use.

In: text tables, tiled GeoTIFFs, CRS definitions. Out: arrays with their metadata, checked; images are written whole or not at all.
"""

from ..lazy import public

__getattr__, __all__ = public(__name__, {
    "cloud_crs": ("check_projected", "crs_note", "unit_note"),
    "crs": ("check_metric", "check_same_crs", "crs_name", "horizontal_part", "moved_by", "parse_crs", "same_crs"),
    "crs_place": ("check_place", "place_on_ground"),
    "gdal_errors": ("gdal_exceptions",),
    "geotiff": ("IntensityImage", "filled_tiles", "new_geotiff", "write_display_image"),
    "text_table": ("NumberTable", "read_number_table"),
    "local_files": ("check_local", "offline", "open_raster", "open_vector"),
    "unfinished": ("finish_file", "unfinished_path"),
    "units": ("FileUnits", "as_in_file", "in_metres", "place_of_raster", "place_raster", "plane_wkt", "unit_names"),
})
