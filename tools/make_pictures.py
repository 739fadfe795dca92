"""A picture for every algorithm's page of the manual: its result on the sample survey, drawn by QGIS in its own style.

Runs every algorithm once on a short sample street (a minute or so), then some on two more scenes (minutes), and writes
docs/manual/img/<algorithm>.png.
"""

import os
import tempfile
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from legend_pictures import draw_all
from palette import with_palette
from plugin_package import ROOT, load

PICTURES = ROOT / "docs" / "manual" / "img"
WIDTH, HEIGHT = 760, 300  # pixels
NEAR = 22.0               # m of road that a detail shows
MOST_POINTS = 250_000     # of a cloud that are drawn


def run(name, **inputs):
    from qgis import processing
    from qgis.core import QgsApplication

    algorithm = QgsApplication.processingRegistry().algorithmById(f"lanewright:{name}")
    rest = {d.name(): "TEMPORARY_OUTPUT" for d in algorithm.destinationParameterDefinitions() if d.name() not in inputs}
    return processing.run(algorithm, {**rest, **inputs})


def stages(folder):
    """Every algorithm's results on the sample, {algorithm: {output: path}}."""
    def at(name):
        return str(folder / name)

    made = {}
    sample = made["samplesurvey"] = run(
        "samplesurvey", LENGTH=70, POINT_CLOUD=at("cloud.laz"), TRAJECTORY=at("drive.gpkg"), TRUTH_BOUNDARIES=at("truth_b.gpkg"),
        TRUTH_MARKINGS=at("truth_m.gpkg"), TRUTH_DRIVING_LINES=at("truth_d.gpkg"), UAV_IMAGE=at("uav.tif"), UAV_GCPS=at("gcps.gpkg"))
    survey = dict(POINT_CLOUDS=[sample["POINT_CLOUD"]], TRAJECTORY=sample["TRAJECTORY"])
    drive = dict(TRAJECTORY=sample["TRAJECTORY"])
    made["importtrajectory"] = run("importtrajectory", INPUT=sample["TRAJECTORY"], OUTPUT=at("trajectory.gpkg"))
    made["estimatetrajectory"] = run("estimatetrajectory", POINT_CLOUDS=survey["POINT_CLOUDS"], TRAJECTORY=at("estimated.gpkg"))
    made["inspectsurvey"] = run("inspectsurvey", **survey, DENSITY=at("density.tif"))
    made["normalizedscanlines"] = run("normalizedscanlines", **survey, INTERVAL=0.5, SCANLINES=at("scanlines.gpkg"))
    made["boundariesfromscanlines"] = run("boundariesfromscanlines", SCANLINES=made["normalizedscanlines"]["SCANLINES"], **drive,
                                          CORNERS=at("corners.gpkg"), BOUNDARIES=at("boundaries.gpkg"))
    made["detectcurbs"] = run("detectcurbs", **survey, CURB_POINTS=at("curbs.gpkg"))
    made["fitroadedges"] = run("fitroadedges", CURB_POINTS=made["detectcurbs"]["CURB_POINTS"], **drive, ROAD_EDGES=at("edges.gpkg"))
    made["detectboundaries"] = run("detectboundaries", **survey, BOUNDARY_METHOD="both", ROAD_EDGES=at("both.gpkg"))
    edges = made["fitroadedges"]["ROAD_EDGES"]
    surface = made["extractroadsurface"] = run("extractroadsurface", **survey, ROAD_EDGES=edges, ROAD_POINTS=at("road.laz"),
                                               ROAD_SURFACE=at("surface.gpkg"))
    made["correctintensity"] = run("correctintensity", ROAD_POINTS=surface["ROAD_POINTS"], **drive, OUTPUT=at("even.laz"))
    even = made["correctintensity"]["OUTPUT"]
    image = made["intensityimage"] = run("intensityimage", ROAD_POINTS=even, INTENSITY_IMAGE=at("image.tif"))
    paint = made["extractmarkings"] = run("extractmarkings", ROAD_POINTS=even, INTENSITY_IMAGE=image["INTENSITY_IMAGE"], **drive,
                                          MARKING_POINTS=at("paint.laz"), MARKING_MASK=at("mask.tif"))
    made["removeoutliers"] = run("removeoutliers", INPUT=paint["MARKING_POINTS"], OUTPUT=at("kept.laz"))
    clusters = made["clustermarkings"] = run("clustermarkings", MARKING_POINTS=made["removeoutliers"]["OUTPUT"], **drive,
                                             MARKINGS=at("markings.gpkg"), CLUSTERED_POINTS=at("clusters.laz"))
    lines = made["fitmarkinglines"] = run("fitmarkinglines", **clusters_of(clusters), **drive, MARKING_LINES=at("lines.gpkg"))
    driving = made["drivinglines"] = run("drivinglines", MARKING_LINES=lines["MARKING_LINES"], MARKINGS=clusters["MARKINGS"], ROAD_EDGES=edges,
                                         ROAD_POINTS=even, **drive, DRIVING_LINES=at("driving.gpkg"), CURVE_ELEMENTS=at("elements.gpkg"))
    made["roadmap"] = dict(MARKING_LINES=lines["MARKING_LINES"], ROAD_EDGES=edges, DRIVING_LINES=driving["DRIVING_LINES"],
                           MARKINGS=clusters["MARKINGS"], ROAD_SURFACE=surface["ROAD_SURFACE"])
    made["crosssections"] = run("crosssections", **survey, ROAD_EDGES=edges, MARKING_LINES=lines["MARKING_LINES"], INTERVAL=5, MAX_CROSSFALL=2.6,
                                DRIVING_LINES=driving["DRIVING_LINES"], OUTPUT=at("sections.gpkg"))
    made["roadside"] = run("roadside", **survey, ROAD_EDGES=edges, OUTPUT=at("roadside.gpkg"), OBJECTS=at("objects.gpkg"))
    made["assessboundaries"] = run("assessboundaries", INPUT=edges, REFERENCE=sample["TRUTH_BOUNDARIES"], **drive, OUTPUT=at("a_b.gpkg"))
    made["assessmarkings"] = run("assessmarkings", INPUT=clusters["MARKINGS"], REFERENCE=sample["TRUTH_MARKINGS"], **drive,
                                 OUTPUT=at("a_m.gpkg"))
    made["assessdrivinglines"] = run("assessdrivinglines", INPUT=driving["DRIVING_LINES"], REFERENCE=sample["TRUTH_DRIVING_LINES"], **drive,
                                     OUTPUT=at("a_d.gpkg"))
    made["georeferenceimage"] = run("georeferenceimage", IMAGE=sample["UAV_IMAGE"], GCPS=sample["UAV_GCPS"], ORDER=2, OUTPUT=at("ortho.tif"),
                                    RESIDUALS=at("residuals.gpkg"))
    made["paintcolours"] = run("paintcolours", **some_yellow(made["georeferenceimage"]["OUTPUT"], clusters["MARKINGS"], at("yellow.tif")),
                               MARKINGS=clusters["MARKINGS"], MARKING_LINES=lines["MARKING_LINES"], COLOURED_MARKINGS=at("c_m.gpkg"),
                               COLOURED_LINES=at("c_l.gpkg"))
    made["proposecontrolpoints"] = run("proposecontrolpoints", IMAGE=sample["UAV_IMAGE"], INTENSITY_IMAGE=image["INTENSITY_IMAGE"],
                                       CONTROL_POINTS=at("proposed.gpkg"))
    made["paintcolours"]["ROAD_SURFACE"] = surface["ROAD_SURFACE"]
    made["image"] = image["INTENSITY_IMAGE"]
    made["street"] = dict(**survey, **made["roadmap"])
    return made


def some_yellow(image, markings, path):
    """The orthoimage with centre lines painted yellow, as roads with works have them; {name of the parameter: file}."""
    from osgeo import gdal

    gdal.Translate(path, image)
    dataset = gdal.Open(path, gdal.GA_Update)
    gdal.Rasterize(dataset, markings, layers=[Path(markings).stem], bands=[3], burnValues=[60], where="class IN ('centre', 'lane')")
    return {"IMAGE": path}


def clusters_of(results):
    return {name: results[name] for name in ("MARKINGS", "CLUSTERED_POINTS")}


# algorithm -> (outputs from above, with the style's output name where it is another; whether the image lies below; a detail?)
PLANS = ("extractroadsurface", "roadmap", "paintcolours")  # drawn as a road plan; over the image the colours by class are seen better
ON_WHITE = ("samplesurvey", "normalizedscanlines", "inspectsurvey", *PLANS)
DRAWN = {
    "samplesurvey": (["TRUTH_DRIVING_LINES", "TRUTH_BOUNDARIES", "TRUTH_MARKINGS"], False, False),
    "importtrajectory": ([("OUTPUT", "TRAJECTORY")], True, False),
    "estimatetrajectory": (["TRAJECTORY"], True, False),
    "inspectsurvey": (["DENSITY"], False, False),
    "normalizedscanlines": (["SCANLINES"], False, True),
    "boundariesfromscanlines": ([("CORNERS", "CURB_POINTS"), ("BOUNDARIES", "ROAD_EDGES")], True, True),
    "detectcurbs": (["CURB_POINTS"], True, False),
    "fitroadedges": (["ROAD_EDGES"], True, False),
    "detectboundaries": (["ROAD_EDGES"], True, False),
    "extractroadsurface": (["ROAD_SURFACE"], False, False),
    "correctintensity": ([("OUTPUT", "cloud")], False, True),
    "intensityimage": (["INTENSITY_IMAGE"], False, True),
    "extractmarkings": (["MARKING_MASK"], False, True),
    "removeoutliers": ([("OUTPUT", "cloud")], False, True),
    "clustermarkings": (["MARKINGS"], True, True),
    "fitmarkinglines": (["MARKING_LINES"], True, False),
    "paintcolours": ([("COLOURED_LINES", "MARKING_LINES"), ("COLOURED_MARKINGS", "MARKINGS"), "ROAD_SURFACE"], False, True),
    "drivinglines": (["DRIVING_LINES"], True, False),
    "roadmap": (["DRIVING_LINES", "ROAD_EDGES", "MARKING_LINES", "MARKINGS", "ROAD_SURFACE"], False, False),
    "crosssections": ([("OUTPUT", "CROSS_SECTIONS")], True, False),
    "roadside": ([("OBJECTS", "ROADSIDE_OBJECTS"), ("OUTPUT", "ROADSIDE")], True, False),
    "assessboundaries": ([("OUTPUT", "ASSESSED_LINES")], True, False),
    "assessmarkings": ([("OUTPUT", "ASSESSED_POLYGONS")], True, True),
    "assessdrivinglines": ([("OUTPUT", "ASSESSED_LINES")], True, False),
    "proposecontrolpoints": (["CONTROL_POINTS"], True, False),
    "georeferenceimage": (["RESIDUALS", ("OUTPUT", "ORTHOIMAGE")], False, False),
}


def layer(path, look, plan=True):
    """A result as a styled layer, as a road plan or by class."""
    from lanewright.processing_provider.styling import LOOKS, STYLES, apply_style
    from qgis.core import QgsContrastEnhancement, QgsRasterLayer, QgsVectorLayer

    if look == "cloud":
        return cloud_layer(path)
    made = QgsRasterLayer(path, look) if path.endswith(".tif") else QgsVectorLayer(path, look, "ogr")
    assert made.isValid(), path
    if look == "MARKING_MASK":
        white = QgsContrastEnhancement(made.dataProvider().dataType(1))
        white.setMinimumValue(0)
        white.setMaximumValue(1)
        white.setContrastEnhancementAlgorithm(QgsContrastEnhancement.ContrastEnhancementAlgorithm.StretchToMinimumMaximum)
        made.renderer().setContrastEnhancement(white)
        return made
    name, _ = LOOKS[look]
    if name:
        by_class = STYLES / "by_class" / f"{name}.qml"
        apply_style(made, by_class if by_class.exists() and not plan else STYLES / f"{name}.qml")
    return made


def cloud_layer(path):
    """Some points of a cloud, grey by intensity: this QGIS cannot show LAZ itself."""
    import laspy
    import numpy as np
    from qgis.core import QgsFeature, QgsGeometry, QgsGraduatedSymbolRenderer, QgsMarkerSymbol, QgsPointXY, QgsRendererRange, QgsVectorLayer

    points = laspy.read(path)
    step = max(1, len(points) // MOST_POINTS)
    x, y = np.asarray(points.x)[::step], np.asarray(points.y)[::step]
    names = set(points.point_format.dimension_names)
    value = np.asarray(points["intensity_corrected"] if "intensity_corrected" in names else points.intensity, float)[::step]
    low, high = np.percentile(value, (1, 99))
    shade = np.clip((value - low) / max(high - low, 1e-9), 0, 0.999)
    made = QgsVectorLayer(f"Point?crs={points.header.parse_crs().to_wkt()}&field=shade:double", "cloud", "memory")
    features = []
    for place in zip(x, y, shade):
        feature = QgsFeature(made.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(float(place[0]), float(place[1]))))
        feature.setAttributes([float(place[2])])
        features.append(feature)
    made.dataProvider().addFeatures(features)
    ranges = []
    for k in range(8):
        grey = 40 + 28 * k
        symbol = QgsMarkerSymbol.createSimple({"size": "0.35", "color": f"{grey},{grey},{grey}", "outline_style": "no"})
        ranges.append(QgsRendererRange(k / 8, (k + 1) / 8, symbol, ""))
    made.setRenderer(QgsGraduatedSymbolRenderer("shade", ranges))
    made.updateExtents()
    return made


def draw(layers, path, surface, detail, ground):
    """Render the layers along the road of the surface layer."""
    from qgis.core import QgsGeometry, QgsMapRendererParallelJob, QgsMapSettings, QgsRectangle
    from qgis.PyQt.QtCore import QSize
    from qgis.PyQt.QtGui import QColor

    whole = QgsGeometry.collectGeometry([feature.geometry().convexHull() for feature in surface.getFeatures()])
    box, _, angle, length, width = whole.orientedMinimumBoundingBox()
    if width > length:
        length, width, angle = width, length, angle - 90.0
    centre, angle = box.centroid().asPoint(), (angle + 90.0) % 180.0 - 90.0  # the road along the picture
    span = NEAR if detail else length + 4
    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(surface.crs())
    height = HEIGHT if detail else int(min(max(WIDTH * (width + 4) / span, 180), 420))
    settings.setOutputSize(QSize(WIDTH, height))
    settings.setOutputDpi(96)
    settings.setExtent(QgsRectangle.fromCenterAndSize(centre, span, span * height / WIDTH))
    settings.setRotation(-angle)
    settings.setBackgroundColor(QColor(ground))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    image = job.renderedImage()
    colours = {image.pixel(x, y) for x in range(0, WIDTH, 7) for y in range(0, height, 7)}
    assert len(colours) >= 2, f"{path} shows nothing"
    with_palette(image).save(str(path), quality=0)


def main():
    from qgis.core import QgsApplication

    load()
    application = QgsApplication([], True)   # symbols of a legend are drawn by the interface
    application.initQgis()
    import sys

    sys.path.append(str(Path(application.pkgDataPath()) / "python" / "plugins"))
    from processing.core.Processing import Processing

    Processing.initialize()
    from lanewright import classFactory

    plugin = classFactory(None)
    plugin.initProcessing()
    PICTURES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        made = stages(Path(folder))
        surface, image = layer(made["extractroadsurface"]["ROAD_SURFACE"], "ROAD_SURFACE"), layer(made["image"], "INTENSITY_IMAGE")
        for name, (outputs, on_image, detail) in DRAWN.items():
            pairs = [output if isinstance(output, tuple) else (output, output) for output in outputs]
            layers = [layer(made[name][output], look, name in PLANS) for output, look in pairs]
            draw(layers + [image] * on_image, PICTURES / f"{name}.png", surface, detail, "#fafafa" if name in ON_WHITE else "#1c1c1e")
            print(name, flush=True)
        draw_all(run, Path(folder), PICTURES, made["street"])
    missing = {algorithm.name() for algorithm in plugin.provider.algorithms()} - {path.stem for path in PICTURES.glob("*.png")}
    print("without a picture:", *sorted(name for name in missing if " " not in name))
    os._exit(0)


if __name__ == "__main__":
    main()
