"""Corners and boundary lines from normalized scanlines."""

from ...core.common.features import CURB_POINTS, ROAD_EDGES, SCANLINES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import frame_of
from ..texts import tr

SCANLINES_OF = "core.road.scanlines.detect:ScanlineBoundarySettings"

BOUNDARY_SETTINGS = (
    SettingSpec("MIN_HEIGHT", SCANLINES_OF, "min_height", tr("Least height of a step, 0 = as the data allow (m)"),
                tr("As the data allow, 3 cm count, and less, down to 2 cm, where a step stands out from the noise and continues for 5 m. A number is "
                   "your own limit: lower finds dropped curbs, but also tar seams and the edges of manholes.")),
    SettingSpec("SEARCH_WIDTH", SCANLINES_OF, "search_width", tr("Search width across a step (m)"),
                tr("The height must change within this width. Wider finds rounded and bevelled curbs, but also ramps."), advanced=True),
    SettingSpec("SENSOR_HEIGHT", SCANLINES_OF, "sensor_height", tr("Trajectory above the road, 0 = from the data (m)"),
                tr("Give it where little road was scanned under the vehicle; otherwise the data know better."), advanced=True),
    SettingSpec("CLIPPING_HEIGHT", SCANLINES_OF, "clipping_height", tr("Height above the road that is looked at (m)"),
                tr("Higher keeps curbs on steeply banked roads, but also low walls and the sills of cars."), advanced=True),
    SettingSpec("DISTANCE_ACROSS", SCANLINES_OF, "distance_across", tr("Reach of a plane across the road (m)"),
                tr("Points this far to either side of a step give its planes. Longer is steadier, shorter keeps to narrow gutters and curb stones."),
                advanced=True),
    SettingSpec("DISTANCE_ALONG", SCANLINES_OF, "distance_along", tr("Reach of a plane along the road (m)"),
                tr("Longer is steadier where points are sparse, shorter follows sharp corners."), advanced=True),
    SettingSpec("RANSAC_DISTANCE", SCANLINES_OF, "ransac_distance", tr("Points of a plane lie within (m)"),
                tr("Larger for noisy scanners; where points scatter more, 1.5 sigma of the plane is taken anyway."), advanced=True),
    SettingSpec("VERTICAL_ANGLE", SCANLINES_OF, "vertical_angle",
                tr("Least angle of a curb face's normal from the vertical, 0 = as the data allow (°)"),
                tr("90 is upright. As the data allow, 60 counts, and less, down to 25, where the face keeps its line for 10 m. A number is your own "
                   "limit: lower accepts bevelled and mountable curbs (40 for a slope of 45°), but also banks."), advanced=True),
    SettingSpec("HORIZONTAL_ANGLE", SCANLINES_OF, "horizontal_angle", tr("Largest angle of road's and sidewalk's normal from the vertical (°)"),
                tr("Larger accepts sloping ground behind the curb."), advanced=True),
    SettingSpec("MAX_GAP", SCANLINES_OF, "max_gap", tr("Longest gap connected (m)"),
                tr("Corners farther apart along the road are not joined. Longer passes driveways and parked cars, and says so.")),
)


class BoundariesFromScanlines(Algorithm):
    ID, TITLE, GROUP = "boundariesfromscanlines", "Boundaries from scanlines", "Road"
    SUMMARY = "Bottom and top corners of curbs on normalized scanlines, and the boundary lines through them."
    HELP = ("From the vehicle outward every scanline is searched for a step. About each step the points of the neighbouring scanlines "
            "give three planes: road, curb face and sidewalk. Where they meet the scanline's own plane lie the corners. Lines are cut "
            "by status: measured; bridged, a gap between corners; occluded, a gap that something hides.")
    TAGS = ("curb", "kerb", "boundary", "scanline", "ransac", "corner")
    LOOKS = {"CORNERS": "CURB_POINTS"}

    def declare(self):
        self.add_input("layer", "SCANLINES", tr("Normalized scanlines"), tr("The layer written by Normalized scanlines."), "LineStringZM")
        self.add_trajectory()
        self.add_settings(BOUNDARY_SETTINGS)
        self.add_sink("CORNERS", tr("Curb corners"), tr("Bottoms and tops, one of each per half metre and side."), fields=CURB_POINTS,
                      geometry="PointZ", optional=True)
        self.add_sink("BOUNDARIES", tr("Road boundaries"), tr("Bottom and top lines of either side."), fields=ROAD_EDGES,
                      geometry="LineStringZ", optional=True)

    def work(self, call, progress):
        from ...core.road.scanlines.detect import LayerScanlines, boundary_lines, curbs_from_scanlines
        from ...core.road.weights import SCANLINE
        from ...core.survey.adjustment.register import sigma_of_layer
        from ...products.scanline_layer import scanlines_from_features

        settings = call.settings(BOUNDARY_SETTINGS)
        layer = call.features("SCANLINES", SCANLINES, "LineStringZM")
        frame = frame_of(call, layer.crs, progress)
        frame.pass_sigma = sigma_of_layer(layer)
        lines, interval = scanlines_from_features(layer, frame)
        source = LayerScanlines(lines, frame, interval, layer.crs, settings.sensor_height)
        corners = curbs_from_scanlines(source, settings, SCANLINE.corner_block, progress.part(0.3, 0.95))
        lines = boundary_lines(corners, frame, settings.max_gap, progress.part(0.95, 1.0))
        call.layer("CORNERS", corners.to_features(frame))
        call.layer("BOUNDARIES", lines.to_features(frame))
