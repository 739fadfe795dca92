"""A made survey with known truth."""

from ...core.common.features import CONTROL_POINTS, TRAJECTORY
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import tr
from ..trajectory_source import trajectory_features

SAMPLE = "simulator.survey:SampleSettings"

SAMPLE_SETTINGS = (
    SettingSpec(
        "SCENE", SAMPLE, "scene", tr("Scene"),
        tr("street: two lanes in bends, with curbs and parked cars. rural: a country road without curbs. urban: four lanes with gutters. one-lane "
           "and wide-lane: a single lane of 5.8 or 7 m with arrows in its middle. no-centre-line: two lanes without a line between them. "
           "hatched-island: two directions held apart by a hatched area. motorway: two lanes and a hard shoulder each way, and an exit. serpentine: "
           "a steep road with hairpins. crossing: four arms with turning lanes, one of them not driven. roundabout: a ring with splitter islands, "
           "driven straight on and to the left. outskirts: two lanes with guard rail, concrete barrier, walls, fences and a hedge beside them, "
           "driven both ways. cycle-lanes: two lanes with the word BUS, and cycle lanes with bicycles."),
        choices=("street", "rural", "urban", "one-lane", "wide-lane", "no-centre-line", "hatched-island", "motorway", "serpentine",
                 "crossing", "roundabout", "outskirts", "cycle-lanes")),
    SettingSpec("LENGTH", SAMPLE, "length", tr("Length of the road, 0: as usual for the scene (m)"),
                tr("Longer takes longer to make and to work through, in proportion. Streets are usually 120 m long, a motorway 240 m (600 m at the "
                   "most), a serpentine 200 m (1000 m), a crossing and a roundabout 110 m from end to end (300 m).")),
    SettingSpec("SEED", SAMPLE, "seed", tr("Seed of the random numbers (whole number)"),
                tr("Another seed gives another street with other cars, wear and noise; the same seed gives the same points.")),
    SettingSpec("SPEED", SAMPLE, "speed_kmh", tr("Speed of the vehicle (km/h)"), tr("Faster spreads the scan lines wider apart."), advanced=True),
    SettingSpec("PULSE_RATE", SAMPLE, "pulse_rate", tr("Pulses of each scanner (per second)"), tr("More gives a denser cloud and a larger file."),
                advanced=True),
    SettingSpec("ROTATION_RATE", SAMPLE, "rotation_rate", tr("Scan lines of each scanner (per second)"),
                tr("More brings the lines closer together, with fewer points on each."), advanced=True),
    SettingSpec("RADIUS", SAMPLE, "radius", tr("Radius of the bends (m)"),
                tr("Smaller makes sharper bends; motorway, serpentine, crossing and roundabout have bends of their own."), advanced=True),
)

TRUTHS = (
    ("TRUTH_BOUNDARIES", "truth_boundaries", "LineStringZ", tr("True road boundaries")),
    ("TRUTH_MARKINGS", "truth_markings", "PolygonZ", tr("True markings")),
    ("TRUTH_DRIVING_LINES", "truth_driving_lines", "LineStringZ", tr("True driving lines")),
    ("TRUTH_SURFACE", "truth_surface", "PolygonZ", tr("True road surface")),
    ("TRUTH_LANES", "truth_lanes", "PolygonZ", tr("True lanes")),
    ("TRUTH_ROADSIDE", "truth_roadside", "LineStringZ", tr("True roadside")),
)


class SampleSurvey(Algorithm):
    ID, TITLE, GROUP = "samplesurvey", "Sample survey", "Survey"
    SUMMARY = "Simulates a mobile laser scanning survey of a street, motorway, junction or mountain road, together with its known truth."
    HELP = "Every pulse of two scanners is followed to what it meets first. Figures reached on it are figures on simulated data."
    TAGS = ("sample", "simulation", "test data")
    NUMBERS = (("POINTS", tr("Points")),)
    RETIRED = ("MOUNT_YAW", "CURB_HEIGHT", "GUTTER")

    def declare(self):
        self.add_settings(SAMPLE_SETTINGS)
        self.add_input("crs", "CRS", tr("CRS of the survey"),
                       tr("A projected CRS in metres. The coordinates are the same in each; it only says where on earth they are."), optional=True,
                       advanced=True, default="EPSG:32650")
        self.add_output("cloud", "POINT_CLOUD", tr("Point cloud"))
        self.add_sink("TRAJECTORY", tr("Trajectory"), fields=TRAJECTORY, geometry="PointZ")
        for name, _, geometry, label in TRUTHS:
            self.add_sink(name, label, geometry=geometry, optional=True)
        self.add_output("raster", "UAV_IMAGE", tr("UAV image"),
                        tr("What a UAV sees of the first 150 m: a TIFF of 4 cm pixels without a place on the map, with the distortion of its camera "
                           "and the position tags of a drone. Propose control points and Georeference image find its place. There is none of "
                           "motorway, serpentine, crossing and roundabout."), optional=True, by_default=False)
        self.add_sink("UAV_GCPS", tr("Ground control points of the UAV image"), geometry="PointZ", optional=True, by_default=False,
                      fields=CONTROL_POINTS)

    def work(self, call, progress):
        from ...simulator.survey import make_sample_survey

        settings = call.settings(SAMPLE_SETTINGS, **({"crs": call.crs()} if call.crs() else {}))
        survey = make_sample_survey(settings, progress.part(0.0, 0.1))
        if call.wants("UAV_IMAGE") or call.wants("UAV_GCPS"):
            from ...simulator.orthophoto import seen_from_above

            seen_from_above(survey)
        count = survey.write_cloud(call.new_file("POINT_CLOUD"), progress.part(0.1, 0.9 if call.wants("UAV_IMAGE") else 1.0))
        progress.info(tr("Sample survey: {count} points along {length:.0f} m of road.").format(count=count, length=settings.length))
        if call.wants("UAV_IMAGE"):
            from ...simulator.orthophoto import write_uav_image

            write_uav_image(survey, call.new_file("UAV_IMAGE"), progress.part(0.9, 1.0))
        if call.wants("UAV_GCPS"):
            from ...simulator.orthophoto import uav_control_points

            call.layer("UAV_GCPS", uav_control_points(survey))
        call.layer("TRAJECTORY", trajectory_features(survey.trajectory))
        for name, attribute, _, _ in TRUTHS:
            call.layer(name, getattr(survey, attribute))
        return {"POINTS": count}
