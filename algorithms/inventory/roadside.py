"""What stands beside the road."""

from ...core.common.features import ROADSIDE, ROADSIDE_OBJECTS
from ...core.countries.catalogue import COUNTRIES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import READING_SETTINGS
from ..texts import tr
from .survey_with_borders import add_borders, survey_with_borders

ROADSIDE_OF = "products.inventory.settings:RoadsideSettings"
ABOVE_ROAD = 8.0  # m of height above the road that are read: buildings reach higher than anything that is looked for

ROADSIDE_SETTINGS = (
    SettingSpec("INTERVAL", ROADSIDE_OF, "interval", tr("Longest interval between vertices (m)"),
                tr("Lines have a vertex wherever they bend, and at least one every so many metres. Smaller gives more of them."), advanced=True),
    SettingSpec("COUNTRY", ROADSIDE_OF, "country", tr("Country"),
                tr("Whose lane widths tell two marking lines that bound a lane, where there are no road edges. It is never guessed."),
                choices=tuple(COUNTRIES), advanced=True),
    SettingSpec("REACH", ROADSIDE_OF, "reach", tr("Reach beyond the carriageway's edge (m)"),
                tr("Farther finds what stands behind verge and sidewalk, but also what belongs to the land beside the road.")),
    SettingSpec("MIN_LENGTH", ROADSIDE_OF, "min_length", tr("Shortest line (m)"),
                tr("Shorter finds short pieces of rail and wall, but also cars and bins that stand in a row.")),
    SettingSpec("MIN_HEIGHT", ROADSIDE_OF, "min_height", tr("Lowest line (m)"),
                tr("Lower finds low walls, but also high grass and steps."), advanced=True),
    SettingSpec("MAX_GAP", ROADSIDE_OF, "max_gap", tr("Longest gap bridged (m)"),
                tr("Longer joins what follows in line; shorter distinguishes more lines. What vehicles hide is bridged up to 12 m whatever this is, "
                   "and an opening of 1.5 m or more through which the scanner saw is left open."), advanced=True),
    SettingSpec("MIN_POLE_HEIGHT", ROADSIDE_OF, "min_pole_height", tr("Lowest pole, sign or trunk (m)"),
                tr("Lower finds bollards and delineator posts, but also people."), advanced=True),
)


class Roadside(Algorithm):
    ID, TITLE, GROUP = "roadside", "Roadside", "Inventory"
    SUMMARY = "Finds guard rails, concrete barriers, walls, fences, hedges and gutters as lines, and poles, signs and tree trunks as points."
    HELP = ("What repeats along the road at a steady offset and height is a line; its kind follows from its section: a beam with free height "
            "below, a face that leans back, an upright plane, something that is seen through, something rough. "
            "Buildings and rows of parked cars are none. Where a scanner sees hardly higher than it rides, as heads of many beams do, "
            "what is as high as it is left out: it may be a house front.\n\n"
            "Status says which pieces of a line were measured. Where something stands before it, as parked cars before a wall, and what is seen "
            "of it on both sides agrees in offset and height, it is one line, and the piece between them is bridged and drawn paler. Where the "
            "scanner saw through a gap, as through a gate or a driveway, nothing is drawn.\n\n"
            "Only what stands outside the carriageway counts: give the road edges, or the layers of lines or lanes. Gutters are the lowest points "
            "along an edge that the road falls to; the higher side of a road has none.")
    TAGS = ("guard rail", "barrier", "noise wall", "fence", "hedge", "pole", "sign", "tree", "asset", "street furniture")
    LOOKS = {"OUTPUT": "ROADSIDE", "OBJECTS": "ROADSIDE_OBJECTS"}
    NUMBERS = (("LENGTH", tr("Length of all lines but gutters (m)")), ("POLES", tr("Poles, signs and trunks")))

    def declare(self):
        self.add_survey()
        add_borders(self,
                    tr("With it things are looked for from the edges outward, and gutters along them."),
                    tr("With it the carriageway without edges ends at the outermost line."),
                    tr("With it the carriageway without edges holds every lane."),
                    tr("The same, with shoulders and parking strips."))
        self.add_settings(ROADSIDE_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("OUTPUT", tr("Roadside"), tr("Pieces of lines along the foot, on the ground; those of one line have its number."),
                      fields=ROADSIDE, geometry="LineStringZ")
        self.add_sink("OBJECTS", tr("Poles, signs and trunks"), fields=ROADSIDE_OBJECTS, geometry="PointZ", optional=True)
        self.add_report()

    def work(self, call, progress):
        from ...products.inventory.roadside.find import find_roadside, roadside_to_features
        from ...products.report.inventory import roadside_report

        settings = call.settings(ROADSIDE_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.6), ABOVE_ROAD)
        roadside = find_roadside(survey, layers, settings, progress.part(0.6, 1.0))
        lines, points = roadside_to_features(roadside)
        call.layer("OUTPUT", lines)
        call.layer("OBJECTS", points)
        call.text("REPORT", roadside_report(roadside, lines, points))
        return {"LENGTH": sum(row["length_m"] for row in lines.rows if row["kind"] != "gutter"), "POLES": float(len(points))}
