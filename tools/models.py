"""The graphical models that come with the plugin, as recipes: what goes in, which algorithms, what comes out.

A value "@NAME" is an input of the model, "child.NAME" the output of another algorithm; what is not named keeps
its default.
"""

from dataclasses import dataclass

SURVEY = {"POINT_CLOUDS": "@POINT_CLOUDS", "TRAJECTORY": "@TRAJECTORY", "CRS": "@CRS"}
DRIVE = {"TRAJECTORY": "@TRAJECTORY"}


@dataclass(frozen=True)
class Recipe:
    """file : name of the .model3
    inputs : names of the model's inputs, in the dialog's order
    stages : algorithm -> (its inputs, its outputs that are the model's: (name, title) or a name that is both)
    results : titles, in the order in which the layers arrive
    """

    file: str
    name: str
    description: str
    inputs: tuple
    stages: dict
    results: tuple


ROAD_MAP = Recipe(
    "road_map", "Road map stages",
    "The stages of the road map, one by one, with their results handed on through files: the same result as Road map. Copy it "
    "and change a stage to your needs.",
    ("POINT_CLOUDS", "TRAJECTORY", "BOUNDARY_METHOD", "CRS"),
    {
        "detectboundaries": ({**SURVEY, "BOUNDARY_METHOD": "@BOUNDARY_METHOD"}, ("ROAD_EDGES",)),
        "extractroadsurface": ({**SURVEY, "ROAD_EDGES": "detectboundaries.ROAD_EDGES"}, ("ROAD_SURFACE",)),
        "correctintensity": ({"ROAD_POINTS": "extractroadsurface.ROAD_POINTS", **DRIVE}, (("OUTPUT", "ROAD_POINTS"),)),
        "intensityimage": ({"ROAD_POINTS": "correctintensity.OUTPUT"}, ("INTENSITY_IMAGE",)),
        "extractmarkings": (
            {"ROAD_POINTS": "correctintensity.OUTPUT", "INTENSITY_IMAGE": "intensityimage.INTENSITY_IMAGE", **DRIVE}, ()),
        "removeoutliers": ({"INPUT": "extractmarkings.MARKING_POINTS"}, ()),
        "clustermarkings": ({"MARKING_POINTS": "removeoutliers.OUTPUT", **DRIVE}, ()),
        "fitmarkinglines": (
            {"CLUSTERED_POINTS": "clustermarkings.CLUSTERED_POINTS", "MARKINGS": "clustermarkings.MARKINGS",
             "ROAD_EDGES": "detectboundaries.ROAD_EDGES", "ROAD_POINTS": "correctintensity.OUTPUT", **DRIVE},
            (("NAMED_MARKINGS", "MARKINGS"), "MARKING_LINES")),
        "drivinglines": (
            {"MARKING_LINES": "fitmarkinglines.MARKING_LINES", "MARKINGS": "fitmarkinglines.NAMED_MARKINGS",
             "ROAD_EDGES": "detectboundaries.ROAD_EDGES", "ROAD_POINTS": "correctintensity.OUTPUT", **DRIVE},
            ("DRIVING_LINES", "LANES", "CURVE_ELEMENTS")),
    },
    ("Road edges", "Road surface", "Road points",
     "Intensity image", "Markings", "Marking lines",
     "Driving lines", "Lanes", "Curve elements"),
)

SCANLINE_BOUNDARIES = Recipe(
    "scanline_boundaries", "Scanline boundary stages",
    "Road boundaries alone, by normalized scanlines: the measured surface is cut by planes across the road, and bottom and "
    "top of the curb are the corners of the planes fitted to it.",
    ("POINT_CLOUDS", "TRAJECTORY", "CRS"),
    {
        "normalizedscanlines": (SURVEY, ("SCANLINES",)),
        "boundariesfromscanlines": ({"SCANLINES": "normalizedscanlines.SCANLINES", **DRIVE}, ("CORNERS", "BOUNDARIES")),
    },
    ("Scanlines", "Corners", "Boundaries"),
)

ASSESSED_ROAD_MAP = Recipe(
    "assessed_road_map", "Markings and driving lines with assessment",
    "The road map, and how its markings and driving lines compare with reference layers of your own: reports, and layers "
    "coloured by outcome.",
    ("POINT_CLOUDS", "TRAJECTORY", "REFERENCE_MARKINGS", "REFERENCE_LINES", "BOUNDARY_METHOD", "CRS"),
    {
        "roadmap": ({**SURVEY, "BOUNDARY_METHOD": "@BOUNDARY_METHOD"},
                    ("MARKINGS", "DRIVING_LINES", "INTENSITY_IMAGE", ("REPORT", "ROAD_MAP_REPORT"))),
        "assessmarkings": ({"INPUT": "roadmap.MARKINGS", "REFERENCE": "@REFERENCE_MARKINGS", **DRIVE},
                           (("OUTPUT", "ASSESSED_MARKINGS"), ("REPORT", "MARKINGS_REPORT"))),
        "assessdrivinglines": ({"INPUT": "roadmap.DRIVING_LINES", "REFERENCE": "@REFERENCE_LINES", **DRIVE},
                               (("OUTPUT", "ASSESSED_DRIVING_LINES"), ("REPORT", "DRIVING_LINES_REPORT"))),
    },
    ("Markings", "Driving lines", "Intensity image", "Assessed markings",
     "Assessed driving lines", "Road map report", "Markings report",
     "Driving lines report"),
)

MAP_LAYERS = {name: f"roadmap.{name}" for name in ("LANES", "DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES", "MARKINGS")}

HD_MAP = Recipe(
    "hd_map", "Survey to HD map",
    "The road map, and the same lanes as OpenDRIVE and Lanelet2 files.",
    ("POINT_CLOUDS", "TRAJECTORY", "BOUNDARY_METHOD", "CRS"),
    {
        "roadmap": ({**SURVEY, "BOUNDARY_METHOD": "@BOUNDARY_METHOD"},
                    ("ROAD_EDGES", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES")),
        "exportopendrive": (MAP_LAYERS, (("OUTPUT", "OPENDRIVE_FILE"),)),
        "exportlanelet2": (MAP_LAYERS, (("OUTPUT", "LANELET2_FILE"),)),
    },
    ("Road edges", "Markings", "Marking lines", "Driving lines", "Lanes", "Opendrive file", "Lanelet2 file"),
)

RECIPES = (ROAD_MAP, SCANLINE_BOUNDARIES, ASSESSED_ROAD_MAP, HD_MAP)
