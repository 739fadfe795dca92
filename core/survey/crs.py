"""The coordinate reference system a survey is worked in: projected, in metres, and agreed on."""

from ..errors import RoadExtractionError


def parse_crs(text):
    """A pyproj CRS of WKT, "EPSG:n" or PROJ text; None for an empty text.

    Raises
    ------
    RoadExtractionError
        If the text is not understood.
    """
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    if not text:
        return None
    try:
        return CRS.from_user_input(text)
    except CRSError as problem:
        raise RoadExtractionError(f"The CRS {text[:60]!r} is not understood ({problem}). Give it as EPSG:number.") from problem


def horizontal(crs):
    """The projected or geographic part of a CRS, a compound one included."""
    if crs is not None and crs.is_compound:
        return crs.sub_crs_list[0]
    return crs


def check_projected(files, given="", trajectory_crs=""):
    """WKT of the CRS that the survey is worked in ("" where none is known).

    The clouds' own CRS counts first, then `given`, then the trajectory's.

    Raises
    ------
    RoadExtractionError
        If clouds disagree, the CRS is geographic, or its unit is not the metre.
    """
    known = {}
    for file in files:
        if file.crs:
            known.setdefault(file.crs, file.path)
    parsed = [(parse_crs(wkt), path) for wkt, path in known.items()]
    for crs, path in parsed[1:]:
        if not horizontal(crs).equals(horizontal(parsed[0][0]), ignore_axis_order=True):
            raise RoadExtractionError(
                f"The point clouds use different CRSs: {parsed[0][1]} is in {horizontal(parsed[0][0]).name}, "
                f"{path} in {horizontal(crs).name}. Reproject them to one CRS first.")
    wkt = next(iter(known), "") or given or trajectory_crs
    crs = parse_crs(wkt)
    if crs is None:
        return ""
    check_metric(crs, "The point cloud")
    return wkt if wkt in known or len(wkt) > 20 else crs.to_wkt()


def check_metric(crs, what):
    """Refuse, by name, a CRS that is geographic or not in metres."""
    flat = horizontal(crs)
    if flat.is_geographic:
        raise RoadExtractionError(
            f"{what} is in the geographic CRS {flat.name} (degrees). Road geometry needs metres: reproject it to a "
            "projected CRS, such as the UTM zone of the survey, and run again.")
    units = {axis.unit_name for axis in flat.axis_info if axis.direction.lower() not in ("up", "down")}
    if units - {"metre", "meter", "m"}:
        raise RoadExtractionError(
            f"{what} is in {flat.name}, whose unit is {', '.join(sorted(units))}. Lanewright works in metres: "
            "reproject it to a metric CRS and run again.")
    if crs.is_compound:
        vertical = {axis.unit_name for axis in crs.sub_crs_list[-1].axis_info}
        if vertical - {"metre", "meter", "m"}:
            raise RoadExtractionError(
                f"{what} has heights in {', '.join(sorted(vertical))} ({crs.sub_crs_list[-1].name}). Lanewright works "
                "in metres: convert the heights and run again.")
