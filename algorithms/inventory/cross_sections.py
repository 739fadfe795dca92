"""Cross-sections of the road."""

from ...core.common.features import CROSS_SECTIONS
from ...core.countries.catalogue import COUNTRIES
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..survey_input import READING_SETTINGS
from ..texts import tr
from .survey_with_borders import add_borders, survey_with_borders

SECTIONS = "products.inventory.settings:CrossSectionSettings"
ABOVE_ROAD = 12.0  # m of height above the road that are read: more than any clearance that a rule asks for

SECTION_SETTINGS = (
    SettingSpec("INTERVAL", SECTIONS, "interval", tr("Interval of the sections (m)"),
                tr("Smaller shows where a rut or a change of crossfall begins, but takes longer; below 10 m grade and ruts are measured over that "
                   "length only.")),
    SettingSpec("COUNTRY", SECTIONS, "country", tr("Country"),
                tr("Whose rules give the limits that are left at 0; neutral has none, and nothing is judged. Also whose usual lane is measured about "
                   "the track where no layer of the road map is given. It is never guessed."), choices=tuple(COUNTRIES)),
    SettingSpec("MAX_RUT", SECTIONS, "max_rut", tr("Rut depth at most, 0 = of the country (mm)"),
                tr("Deeper ruts under a straight edge of 2 m are marked. Lower finds shallow ones, down to what noise leaves, about 2 mm.")),
    SettingSpec("MIN_CROSSFALL", SECTIONS, "min_crossfall", tr("Crossfall at least, 0 = of the country (%)"),
                tr("Lanes that fall less to either side are marked: water stands there. Lower leaves the places where the crossfall changes sides "
                   "unmarked."), advanced=True),
    SettingSpec("MAX_CROSSFALL", SECTIONS, "max_crossfall", tr("Crossfall at most, 0 = of the country (%)"),
                tr("Steeper lanes are marked. Lower marks the superelevation of bends too."), advanced=True),
    SettingSpec("MAX_GRADE", SECTIONS, "max_grade", tr("Grade at most, 0 = of the country (%)"),
                tr("Steeper sections are marked, climbing or falling. Lower marks ramps too."), advanced=True),
    SettingSpec("MIN_WIDTH", SECTIONS, "min_width", tr("Lane width at least, 0 = of the country (m)"),
                tr("Narrower driving lanes are marked. Higher marks turning lanes too."), advanced=True),
    SettingSpec("MIN_CLEARANCE", SECTIONS, "min_clearance", tr("Clearance at least, 0 = of the country (m)"),
                tr("Sections with something hanging lower are marked. Higher finds branches above the traffic too."), advanced=True),
)


class CrossSections(Algorithm):
    ID, TITLE, GROUP = "crosssections", "Cross-sections", "Inventory"
    SUMMARY = "Measures width, crossfall, grade, rut depth, curb heights and clearance of every lane at fixed stations against limits."
    HELP = ("Steps between scanners and passes are estimated where they overlap and taken off first. An error in roll looks like crossfall: passes "
            "in opposite directions distinguish the two, and where there are none the report says so and the sigma of the crossfall holds it.\n\n"
            "Lanes are those of the layer Lanes, else of the driving lines between the marking lines, else of the marking lines alone; the "
            "carriageway ends at the road edges, else at the outermost line. Rut depths are measured under a straight edge of 2 m laid over profiles "
            "averaged over 1 m of road (over more where points are few), less what noise adds. Something that stands on the road does not "
            "count as hanging above it.\n\n"
            "Judged is what the rules of the country chosen say, and what you set a limit for. Field why gives value, limit and rule. A "
            "crossfall is marked where twice its sigma does not explain it.")
    TAGS = ("profile", "rutting", "crossfall", "superelevation", "clearance", "road condition", "width")
    LOOKS = {"OUTPUT": "CROSS_SECTIONS"}
    NUMBERS = (("SECTIONS", tr("Sections")),
               ("EXCEEDED", tr("Lanes and carriageways that exceed a limit")),
               ("LARGEST_RUT", tr("Greatest rut depth (mm)")),
               ("LEAST_CLEARANCE", tr("Least clearance (m)")))

    def declare(self):
        self.add_survey()
        add_borders(self,
                    tr("With it the carriageway ends at the edges, and heights of curbs are measured there."),
                    tr("With it lanes end at the painted lines."),
                    tr("With it lanes have their numbers and directions; not needed beside Lanes."),
                    tr("With it every lane, shoulder and parking strip of the road map is measured."))
        self.add_settings(SECTION_SETTINGS)
        self.add_settings(READING_SETTINGS)
        self.add_sink("OUTPUT", tr("Cross-sections"), tr("A line across every lane and carriageway at every section."), fields=CROSS_SECTIONS,
                      geometry="LineStringZ")
        self.add_sink("TABLE", tr("Table of the cross-sections"), tr("The same rows without lines, for spreadsheets."), fields=CROSS_SECTIONS,
                      geometry="None", optional=True, by_default=False)
        self.add_output("file", "DRAWING", tr("Drawing of the sections"), tr(
            "Every section true to scale, one below the other, with stations, heights and slopes, for CAD; lengths are metres."),
                        suffixes=(".dxf",), file_filter="DXF (*.dxf)", optional=True, by_default=False)
        self.add_report()

    def work(self, call, progress):
        from ...products.inventory.cross_sections import measure_cross_sections, sections_to_features
        from ...products.report.inventory import cross_section_report

        settings = call.settings(SECTION_SETTINGS)
        survey, layers = survey_with_borders(call, progress.part(0.0, 0.5), ABOVE_ROAD)
        sections = measure_cross_sections(survey, layers, settings, progress.part(0.5, 1.0))
        lines, table = sections_to_features(sections)
        call.layer("OUTPUT", lines)
        call.layer("TABLE", table)
        if call.wants("DRAWING"):
            from ...products.cad import section_drawing, write_dxf

            write_dxf(section_drawing(sections), call.new_file("DRAWING"))
        call.text("REPORT", cross_section_report(sections, table))
        return _numbers(table, len(sections.sections))


def _numbers(table, count):
    ruts = [value for name in ("rut_l_mm", "rut_r_mm") for value in table.column(name) if value is not None]
    clear = [value for value in table.column("clear_m") if value is not None]
    counts = {"SECTIONS": float(count), "EXCEEDED": float(sum(bool(row["exceeds"]) for row in table.rows))}
    return {**counts, **({"LARGEST_RUT": max(ruts)} if ruts else {}), **({"LEAST_CLEARANCE": min(clear)} if clear else {})}
