"""The road map on paper: sheets along the road with profile and cross-sections, as one PDF."""

from dataclasses import dataclass

from ...core.common.setting import check_limits, setting
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import languages, tr

SETTINGS = "algorithms.export.print_sheets:SheetSettings"
PAPERS = ("A4", "A3", "A2", "A1", "A0")
SCALES = ("1:100", "1:200", "1:250", "1:500", "1:1000", "1:2000", "1:2500", "1:5000")
# Results that are drawn, from above
DRAWN = (("DRIVING_LINES", tr("Driving lines"), "LineStringZ"), ("ROAD_EDGES", tr("Road edges"), "LineStringZ"),
         ("MARKING_LINES", tr("Marking lines"), "LineStringZ"), ("MARKINGS", tr("Markings"), "PolygonZ"), ("LANES", tr("Lanes"), "PolygonZ"),
         ("ROAD_SURFACE", tr("Road surface"), "PolygonZ"))


@dataclass(frozen=True)
class SheetSettings:
    """What the user chose; what is "" is filled in by the program."""

    title: str = ""
    office: str = ""
    author: str = ""
    heights: str = ""
    credit: str = ""
    paper: str = "A3"
    orientation: str = "landscape"
    scale: str = "automatic"
    profile: bool = True
    section_interval: float = setting(20.0, 0.0, 10_000.0, "Interval of the cross-sections", "m")

    def __post_init__(self) -> None:
        check_limits(self)


SHEET_SETTINGS = (
    SettingSpec("TITLE", SETTINGS, "title", tr("Title (project)"),
                tr("Stands large in the title block and is the name of the layout. Empty takes the name of the survey.")),
    SettingSpec("OFFICE", SETTINGS, "office", tr("Office"), tr("Who is responsible for the plan, for the title block. Save it with Presets.")),
    SettingSpec("AUTHOR", SETTINGS, "author", tr("Author"), tr("Who made the plan, for the title block.")),
    SettingSpec("PAPER", SETTINGS, "paper", tr("Paper"),
                tr("Larger paper gives fewer sheets at the same scale, but needs a plotter from A2 on."), choices=PAPERS),
    SettingSpec("ORIENTATION", SETTINGS, "orientation", tr("Orientation"),
                tr("landscape shows more of the road along each sheet; portrait shows more beside it, as at a junction or on a winding road."),
                choices=("landscape", "portrait")),
    SettingSpec("SCALE", SETTINGS, "scale", tr("Scale"),
                tr("automatic takes the largest of 1:250, 1:500, 1:1000, 1:2000 and 1:5000 that needs at most 20 sheets and on which the road is not "
                   "wider than the sheet; a road that fits on one sheet may be drawn at 1:100 or 1:200. "
                   "A larger scale shows curbs and paint better on more sheets; below 1:1000 lanes are thin bands."),
                choices=("automatic", *SCALES)),
    SettingSpec("PROFILE", SETTINGS, "profile", tr("Longitudinal profile"),
                tr("Further pages with the height of the ground along the axis, stations and gradients. The layers need heights.")),
    SettingSpec("SECTION_INTERVAL", SETTINGS, "section_interval", tr("Interval of the cross-sections, 0 = none (m)"),
                tr("Further pages with a section at every such station of the axis. Lower shows more of the road on more pages; 0 leaves them out.")),
    SettingSpec("HEIGHT_SYSTEM", SETTINGS, "heights", tr("Height system"),
                tr("What the heights refer to, for the title block, such as DHHN2016. Empty takes the vertical part of the CRS."), advanced=True),
    SettingSpec("CREDIT", SETTINGS, "credit", tr("Credit on the map"),
                tr("Whose data lie below, as their licence wants it said; stands in the lower left corner of the map"), advanced=True),
)


class PrintSheets(Algorithm):
    ID, TITLE, GROUP = "printsheets", "Sheets along the road", "Export"
    SUMMARY = "Draws the road map on sheets of paper that follow the road, with longitudinal profile and cross-sections, as one PDF."
    HELP = ("Every sheet is turned so that the road runs from left to right, overlaps its neighbours, and has match lines with their numbers, the "
            "axis with stations, a grid with coordinates, a key map and a title block. An overview of all sheets with the legend comes "
            "first.\n\nThe axis lies amid the driving lines (else the marking lines, else the road edges); its stations are those of the layers.\n\n"
            "Layers are drawn as they are styled in the project, layers from files as Lanewright styles them. Texts in the title block are printed "
            "as they stand. The accuracy is the median of sigma_m along the lines.")
    TAGS = ("print", "plan", "sheet", "PDF", "layout", "atlas", "profile", "title block", "map")
    NUMBERS = (("SHEETS", tr("Plan sheets")), ("PAGES", tr("Pages")), ("SCALE_NUMBER", tr("Denominator of the scale")))
    DRAWS = True

    def declare(self):
        for name, label, geometry in DRAWN:
            text = tr("Drawn on the sheets, if given.") if geometry == "PolygonZ" else tr("Drawn on the sheets, and leads the axis if given.")
            self.add_input("layer", name, label, text, geometry, optional=True)
        self.add_input("cloud", "ROAD_POINTS", tr("Road points"), tr(
            "With it cross-sections show the ground as it was measured; without it straight lines between edges, paint and driving lines."),
            optional=True)
        self.add_input("painted", "BELOW", tr("Layer below (orthoimage, web map)"), tr(
            "Drawn below all others and left out of the legend. Lanes and Road surface cover it where they are given."),
                       optional=True)
        self.add_settings(SHEET_SETTINGS)
        self.add_input("choice", "LANGUAGE", tr("Language of the sheets"), tr("automatic is the language of the program."), default="automatic",
                       choices=("automatic", *languages()))
        self.add_input("flag", "KEEP", tr("Keep the layout in the project"),
                       tr("Then all pages can be changed in QGIS's layout designer and printed from there: menu Project, Layouts."), default=True)
        self.add_output("file", "OUTPUT", tr("Sheets"), tr("All pages in one file."), suffixes=(".pdf",), file_filter="PDF (*.pdf)")

    def work(self, call, progress):
        return call.print_sheets(call.settings(SHEET_SETTINGS), progress)
