"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from ..common.setting import table


@table
class IO:
    """Text tables, rasters, coordinate systems and files."""

    same_datum: float = 2.0   # m between a place in two realisations of one datum, such as NAD 83 and WGS 84
    same_coordinates: float = 0.01   # m between coordinates of one place in two CRS that are none other for a map
    suspicious_sensor_height: tuple[float, float] = 5.0, 15.0   # m: higher than any survey vehicle; 1.5 to 4.5 m expressed in feet
    # relative: official grids keep within it where they are used; UTM zone 33, used in all of Norway, and Lambert-93 come to 4 per mille
    max_scale_error: float = 0.005
    scale_step: float = 50.0   # m on the map over which the scale is measured
    max_outside_area: float = 8.0   # degrees: official surveys lie outside the area of their CRS too, of UTM zone 33 in Norway by 7.5
    min_exchanged: float = 1.0   # degrees outside, from which on x and y may be exchanged; a survey beyond a border lies nearer
    max_local: float = 1e5   # m: local coordinates, and those without their leading digits, are smaller
    same_unit: float = 1e-9   # relative, between units that are written with other digits; two definitions of the foot differ by 2e-6
    compression_threads: int = 2   # threads that compress a new GeoTIFF
    display_size: int = 2000   # px, longer side of the reduced image from which the stretch is computed
    max_display_step: int = 16   # px between its pixels at the most, where few tiles of a large image hold data
    abandoned_time: float = 24 * 3600.0   # s without a write after which the run of an unfinished file is taken for dead
    sample_bytes: int = 200_000   # bytes from which the format of the table is recognised
    sample_lines: int = 400   # lines of these that are split
    min_number_columns: int = 3   # columns of numbers that make a table
    max_number: float = 1e20   # beyond time in nanoseconds; larger numbers count as missing, like infinity
    fields_per_chunk: int = 200_000   # fields parsed at a time where some are words
