"""Control points of a UAV image, proposed from paint that the intensity image shows too."""

from ...core.common.features import PROPOSED_POINTS
from ..algorithm import Algorithm
from ..parameters import SettingSpec
from ..texts import tr
from .control_point_layer import read_control_point_layer

PROPOSE = "products.overlay.matching.propose:ProposalSettings"

PROPOSE_SETTINGS = (
    SettingSpec("PIXEL_SIZE", PROPOSE, "pixel_size", tr("Pixel size of the image on the ground (m)"),
                tr("Roughly, to a tenth; 0 takes it from the image's position, or from the height and focal length in its tags. With it alone the "
                   "whole intensity image is searched, in every direction.")),
    SettingSpec("SEARCH", PROPOSE, "search", tr("How far the rough position may be off (m)"),
                tr("Larger finds images with poor tags, takes longer, and meets more places that look alike on a road of equal dashes.")),
    SettingSpec("TOLERANCE", PROPOSE, "tolerance", tr("Largest distance from the other pairs (m)"),
                tr("A pair is accepted where the others place it, to so much. Larger keeps pairs of an oblique image that a polynomial follows "
                   "badly."), advanced=True),
    SettingSpec("MIN_SCORE", PROPOSE, "min_score", tr("Smallest likeness of two cut-outs (0-1)"),
                tr("Correlation, 1 for the same picture. Lower accepts worn paint and shadows, higher only what looks the same."), advanced=True),
    SettingSpec("COUNT", PROPOSE, "count", tr("Most pairs that are accepted (points)"),
                tr("They are spread over the image. Half as many doubtful ones are listed besides."), advanced=True),
)


class ProposeControlPoints(Algorithm):
    ID, TITLE, GROUP = "proposecontrolpoints", "Propose control points", "Orthoimages"
    SUMMARY = "Finds the same paint in a UAV image and in the intensity image, as control points for Georeference image."
    HELP = ("The image needs a rough position: two given points, or a world file, or the position tags of the drone, or the size of its "
            "pixels. The paint of both images is laid over each other, the distortion of the camera followed, and about every "
            "corner of paint (ends of dashes, arrows, bars, stop lines) the two cut-outs are compared.\n\n"
            "A pair is accepted by default where its cut-outs look alike, nothing beside it looks the same, and the other pairs place it "
            "where it is. Where the paint repeats so that the whole image fits elsewhere as well, no pair is accepted and a warning says so. "
            "Look through the pairs with Control points from paint in the Lanewright menu, in the report, or in the table: points whose field "
            "accepted is 1 are used by Georeference image, others are not.\n\n"
            "The pairs tell how well the image fits the point cloud, not how well either fits the ground. They lie on the road, so that the "
            "image is reliable there and less so beside it. Sun, shadow and dark paint do no harm; paint renewed between the two surveys does.")
    TAGS = ("UAV", "drone", "GCP", "control points", "matching", "registration", "orthoimage", "georeferencer")
    NUMBERS = (
        ("PROPOSED", tr("Pairs proposed")),
        ("ACCEPTED", tr("Pairs accepted")),
        ("RMSE", tr("RMSE of the accepted pairs, each left out in turn (m)")),
        ("GROUND_PIXEL", tr("Pixel of the image on the ground (m)")),
        ("TURN", tr("Turn of the image, from its rows to east (°)")),
    )

    def declare(self):
        self.add_input("raster", "IMAGE", tr("Image"), tr("TIFF, JPEG, PNG or any other raster that looks straight down, of up to 500 m of ground."))
        self.add_input("raster", "INTENSITY_IMAGE", tr("Intensity image"), tr("As Intensity image and Road map write it."))
        self.add_input("layer", "ROUGH_POINTS", tr("Two rough points"),
                       tr("Where the image has no position: a layer with the fields pixel and line of two or more points far apart, right to some "
                          "metres."), optional=True)
        self.add_settings(PROPOSE_SETTINGS)
        self.add_sink("CONTROL_POINTS", tr("Control points"), tr("As Georeference image takes them."), "PointZ", fields=PROPOSED_POINTS)
        self.add_report()

    def work(self, call, progress):
        from ...core.io.geotiff import IntensityImage
        from ...products.overlay.matching.propose import propose_control_points
        from ...products.overlay.rough_place import rough_place
        from ...products.overlay.source_image import open_image
        from ...products.report.overlay import proposed_points_report

        image = open_image(call.raster("IMAGE"))
        intensity = IntensityImage.open(call.raster("INTENSITY_IMAGE"))
        settings = call.settings(PROPOSE_SETTINGS)
        rough = rough_place(image, intensity.crs, settings.search, settings.pixel_size, _rough_points(call, image, intensity.crs))
        progress.info(tr("The image is looked for by {source}.").format(source=rough.source))
        proposal = propose_control_points(image, intensity, rough, settings, progress.part(0.0, 0.95))
        for note in proposal.notes:
            progress.warn(note)
        values = {"PROPOSED": len(proposal), "ACCEPTED": int(proposal.accepted.sum()), "GROUND_PIXEL": proposal.size, "TURN": proposal.turn_degrees}
        if values["ACCEPTED"]:
            values["RMSE"] = proposal.rmse
            progress.info(tr("{accepted} of {count} pairs accepted, RMSE {rmse:.3f} m, each left out in turn.").format(
                accepted=values["ACCEPTED"], count=values["PROPOSED"], rmse=proposal.rmse))
        call.layer("CONTROL_POINTS", proposal.features())
        if call.wants("REPORT"):
            call.text("REPORT", proposed_points_report(proposal))
        return values


def _rough_points(call, image, crs):
    """Given points in the CRS of the intensity image, None where there are none."""
    from dataclasses import replace

    from ...products.overlay.rough_place import to_map

    source = call.source("ROUGH_POINTS")
    if source is None:
        return None
    points = read_control_point_layer(source, image)
    easting, northing = to_map(points.easting, points.northing, points.crs, crs)
    return replace(points, easting=easting, northing=northing, crs=crs)
