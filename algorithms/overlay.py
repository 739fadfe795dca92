"""UAV images below the road map, placed by ground control points."""

from dataclasses import replace

from ..core.common.errors import RoadExtractionError
from ..core.common.features import PROPOSED_POINTS, RESIDUALS
from .algorithm import Algorithm, settings_of
from .rooms import core, products
from .texts import tr
from .vector_source import LINE, POINT, POLYGON, vertices_of


def read_control_point_layer(source, image, crs=""):
    """ControlPoints of an image, from a VectorSource of points with the fields pixel and line, or a table. crs : WKT where it carries none

    Raises RoadExtractionError if the layer holds lines or polygons, or lacks a field.
    """
    if source.kind in (LINE, POLYGON):
        raise RoadExtractionError(tr("{label}: the layer holds {kind} geometries. Control points are points, or a table.", label=source.label,
                                     kind=source.kind_label(source.kind)))
    placed = source.kind == POINT
    rows = [_row(wkb, values, placed) for wkb, values in source.stored_rows()]
    names = [*source.names, *["mapX", "mapY", "mapZ"] * placed]
    return products.overlay.control_points.control_points(names, rows, image, source.label, source.stored_crs or crs)


def _row(wkb, values, placed):
    if not placed:
        return list(values)
    vertices = vertices_of(wkb) if wkb else []
    if not len(vertices):
        return [*values, None, None, None]
    x, y, z, _ = vertices[0].tolist()
    return [*values, x, y, z if z == z else None]


PROPOSE_SETTINGS = settings_of("products.overlay.matching.propose:ProposalSettings", "PIXEL_SIZE SEARCH TOLERANCE* MIN_SCORE* COUNT*")


class ProposeControlPoints(Algorithm):
    ID, TITLE, GROUP = "proposecontrolpoints", "Propose control points", "Orthoimages"
    NUMBERS = "PROPOSED ACCEPTED RMSE GROUND_PIXEL TURN".split()

    def declare(self):
        self.add_input("raster", "IMAGE")
        self.add_input("raster", "INTENSITY_IMAGE")
        self.add_input("layer", "ROUGH_POINTS", optional=True)
        self.add_settings(PROPOSE_SETTINGS)
        self.add_sink("CONTROL_POINTS", geometry="PointZ", fields=PROPOSED_POINTS)
        self.add_report()

    def work(self, call, progress):
        image = products.overlay.control_points.open_image(call.raster("IMAGE"))
        intensity = core.io.geotiff.IntensityImage.open(call.raster("INTENSITY_IMAGE"))
        settings = call.settings(PROPOSE_SETTINGS)
        points = _rough_points(call, image, intensity.crs)
        rough = products.overlay.rough_place.rough_place(image, intensity.crs, settings.search, settings.pixel_size, points)
        progress.info(tr("The image is looked for by {source}.", source=rough.source))
        proposal = products.overlay.matching.propose.propose_control_points(image, intensity, rough, settings, progress.part(0.0, 0.95))
        progress.warn_all(proposal.notes)
        values = {"PROPOSED": len(proposal), "ACCEPTED": int(proposal.accepted.sum()), "GROUND_PIXEL": proposal.size, "TURN": proposal.turn_degrees}
        if values["ACCEPTED"]:
            values["RMSE"] = proposal.rmse
            progress.info(tr("{accepted} of {count} pairs accepted, RMSE {rmse:.3f} m, each left out in turn.", accepted=values["ACCEPTED"],
                             count=values["PROPOSED"], rmse=proposal.rmse))
        call.layer("CONTROL_POINTS", proposal.features())
        if call.wants("REPORT"):
            call.text("REPORT", products.report.overlay.proposed_points_report(proposal))
        return values


def _rough_points(call, image, crs):
    """Given points in the CRS of the intensity image, None where there are none."""
    source = call.source("ROUGH_POINTS")
    if source is None:
        return None
    points = read_control_point_layer(source, image)
    easting, northing = products.overlay.rough_place.to_map(points.easting, points.northing, points.crs, crs)
    return replace(points, easting=easting, northing=northing, crs=crs)


GEOREFERENCE_SETTINGS = settings_of("products.overlay.georeference:GeoreferenceSettings",
    "ORDER PIXEL_SIZE EXTRAPOLATION* RESAMPLING* CHECK_DISABLED*")


class GeoreferenceImage(Algorithm):
    ID, TITLE, GROUP = "georeferenceimage", "Georeference image", "Orthoimages"
    NUMBERS = "POINTS RMSE LEFT_OUT_RMSE CHECK_POINTS CHECK_RMSE LARGEST OUTSIDE".split()

    def declare(self):
        self.add_input("raster", "IMAGE")
        self.add_input("layer", "GCPS", optional=True)
        self.add_input("file", "GCP_FILE", optional=True, file_filter="Control points (*.points *.csv *.txt *.POINTS *.CSV *.TXT);;All files (*.*)")
        self.add_input("crs", "CRS", optional=True)
        self.add_settings(GEOREFERENCE_SETTINGS)
        self.add_output("raster", "OUTPUT", look="ORTHOIMAGE")
        self.add_sink("RESIDUALS", geometry="LineStringZ", optional=True, fields=RESIDUALS)
        self.add_report()

    def work(self, call, progress):
        image = products.overlay.control_points.open_image(call.raster("IMAGE"))
        if image.geotransform is None:
            # QGIS looks at a raster as a map layer before it starts an algorithm, and passes on what GDAL thinks of it
            progress.info(tr("The image has no position yet; the control points give it one. A line above, GDAL ERROR 1: Unable to compute "
                            "a transformation, is QGIS saying the same and harmless."))
        result = products.overlay.georeference.georeference(image, _control_points(call, image, progress), call.settings(GEOREFERENCE_SETTINGS))
        progress.warn_all(result.notes)
        values = _numbers(result)
        progress.info(tr("Control points: {count}, order {order}, RMSE {rmse:.3f} m, each left out in turn {left:.3f} m.", count=values["POINTS"],
                         order=result.settings.order, rmse=values["RMSE"], left=result.left_out_rmse))
        if values["CHECK_POINTS"]:
            progress.info(tr("Check points: {count}, RMSE {rmse:.3f} m.", count=values["CHECK_POINTS"], rmse=values["CHECK_RMSE"]))
        drawn = call.new_file("OUTPUT")
        departure = products.overlay.georeference.draw_image(result, drawn, progress.part(0.02, 0.97))
        call.layer("RESIDUALS", products.overlay.georeference.residual_vectors(result))
        if call.wants("REPORT"):
            call.text("REPORT", call.in_users_names(products.report.overlay.georeferencing_report(result, drawn, departure)))
        return values


def _control_points(call, image, progress):
    """From the layer or the file, whichever was given."""
    crs = call.crs()
    path = call.file("GCP_FILE")
    source = call.source("GCPS")
    if bool(path) == (source is not None):
        raise RoadExtractionError(
            tr("Control points were given twice, as a layer and as a file. Leave one of them empty.") if path else
            tr("There are no control points. Choose a layer, or a .points or CSV file."))
    points = products.overlay.control_points.read_control_points(path, image, crs) if path else read_control_point_layer(source, image, crs)
    if crs and not core.io.crs.same_crs(core.io.crs.parse_crs(crs), core.io.crs.parse_crs(points.crs)):
        progress.warn(tr("The control points say that they are in {own}; the CRS given is for points that name none and was not used.",
                         own=core.io.crs.horizontal_part(core.io.crs.parse_crs(points.crs)).name))
    return points


def _numbers(result):
    points, roles = result.points, products.overlay.control_points
    lengths = [float((dx * dx + dy * dy) ** 0.5) for dx, dy in result.errors[points.having(roles.CONTROL)]]
    values = {
        "POINTS": len(lengths), "RMSE": result.rmse(), "LEFT_OUT_RMSE": result.left_out_rmse,
        "CHECK_POINTS": len(points.having(roles.CHECK)), "CHECK_RMSE": result.rmse(roles.CHECK), "LARGEST": max(lengths),
        "OUTSIDE": 100.0 * result.outside,
    }
    # JSON knows no NaN: what cannot be told is left out
    return {name: value for name, value in values.items() if value == value}
