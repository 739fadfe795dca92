"""A sample survey with known truth through the whole chain, by the real qgis_process, and a map of the result.

Everything is left in build/demo/. Any stage that fails, and any result that is missing or
empty, ends the demo with an error.
"""

import json
import math
import subprocess
import sys
import time

from plugin_package import ROOT, load

FOLDER = ROOT / "build" / "demo"
PACKAGE = FOLDER / "road_map.gpkg"
TRUTH = FOLDER / "truth.gpkg"
UAV = FOLDER / "uav.gpkg"
UAV_IMAGE, ORTHOIMAGE = FOLDER / "uav.tif", FOLDER / "orthoimage.tif"
TABLES = ("road_surface", "road_edges", "markings", "marking_lines", "driving_lines", "curve_elements")


def stop(text):
    sys.exit(f"The demo failed: {text}")


def process(algorithm, **inputs):
    """Run an algorithm as a user would on the command line; its results by name."""
    began = time.perf_counter()
    run = subprocess.run([str(ROOT / "tools" / "qgis_process"), "run", f"lanewright:{algorithm}", "-"],
                         input=json.dumps({"inputs": inputs}), capture_output=True, text=True)
    if run.returncode:
        stop(f"{algorithm} ended with code {run.returncode}.\n{run.stderr.strip()}")
    results = json.loads(run.stdout)["results"]
    missing = [name for name in inputs if name.isupper() and name in results and not results[name]]
    if missing or not results:
        stop(f"{algorithm} returned no {', '.join(missing) or 'results'}.")
    print(f"{algorithm:<16} {time.perf_counter() - began:6.1f} s")
    return results


def table(package, name):
    """The destination of one layer in a GeoPackage that holds several."""
    return f"ogr:dbname='{package}' table=\"{name}\" (geom)"


def geometries(package, name):
    """Shapely geometries and attribute rows of a GeoPackage layer."""
    import shapely
    from osgeo import ogr

    ogr.UseExceptions()
    source = ogr.Open(str(package))
    layer = source.GetLayerByName(name)
    found, rows = [], []
    for feature in layer:
        geometry = feature.GetGeometryRef()
        found.append(None if geometry is None else shapely.from_wkb(bytes(geometry.ExportToIsoWkb())))
        rows.append(feature.items())
    return found, rows


def check_results(image, cloud, report, picture):
    """Stop unless every result is there and holds something."""
    import laspy
    import shapely
    from osgeo import gdal

    gdal.UseExceptions()
    for name in TABLES:
        found, _ = geometries(PACKAGE, name)
        if not found:
            stop(f"layer {name} of {PACKAGE} is empty.")
        if name != "curve_elements" and not all(shapely.has_z(g) for g in found):
            stop(f"layer {name} of {PACKAGE} has geometries without heights.")
    raster = gdal.Open(str(image))
    band = raster.GetRasterBand(1)
    if not raster.GetProjection() or band.GetNoDataValue() is None or band.Checksum() == 0:
        stop(f"{image} lacks its CRS, its nodata value or any data.")
    with laspy.open(cloud) as reader:
        if not reader.header.point_count:
            stop(f"{cloud} holds no points.")
    for path in (report, picture):
        if not path.exists() or path.stat().st_size < 2000:
            stop(f"{path} is missing or empty.")


def percent(share):
    return "–" if math.isnan(share) else f"{100 * share:.1f} %"


def accuracy():
    """Print how far the result is from the truth of the sample survey."""
    load()
    from lanewright.products.assess.lines import compare_lines
    from lanewright.products.assess.markings import assess_markings

    area = road_area()
    edges = compare_lines(geometries(PACKAGE, "road_edges")[0], _curbs(), area=area)
    paint = assess_markings(geometries(PACKAGE, "markings")[0], geometries(TRUTH, "markings")[0], area=area).tolerant
    lanes = compare_lines(geometries(PACKAGE, "driving_lines")[0], geometries(TRUTH, "driving_lines")[0], area=area)
    print("\nAgainst the truth of the sample survey (simulated data):")
    print(f"  road edges     complete {percent(edges.completeness[0.10])}, right {percent(edges.correctness[0.10])} "
          f"within 10 cm; RMSE {100 * edges.lateral.rmse:.1f} cm across, {100 * edges.height.rmse:.1f} cm in height")
    print(f"  markings       precision {percent(paint.precision)}, recall {percent(paint.recall)}, "
          f"F1 {percent(paint.f1)} (by area, one cell of 4 cm tolerance)")
    print(f"  driving lines  recall {percent(lanes.completeness[0.05])} / {percent(lanes.completeness[0.15])}, "
          f"miscoding {percent(1 - lanes.correctness[0.05])} / {percent(1 - lanes.correctness[0.15])} within 5 / 15 cm; "
          f"RMSE {100 * lanes.lateral.rmse:.1f} cm across, {100 * lanes.height.rmse:.1f} cm in height")
    for what, share in (("road edges", edges.completeness[0.10]), ("markings", paint.f1),
                        ("driving lines", lanes.completeness[0.15])):
        if not share > 0.7:
            stop(f"{what} agree with the truth by {percent(share)} only; 70 % is the least a sound chain gives.")


def _curbs():
    """True curb bottoms, those of dropped curbs too."""
    found, rows = geometries(TRUTH, "boundaries")
    return [g for g, row in zip(found, rows) if row.get("part") != "top" and row.get("edge") in ("curb", "dropped")]


def over_the_uav_image():
    """Georeference the UAV image, set the driving lines against the lanes seen in it, and say how they compare."""
    placed = process("georeferenceimage", IMAGE=str(UAV_IMAGE), GCPS=f"{UAV}|layername=control_points", OUTPUT=str(ORTHOIMAGE),
                     RESIDUALS=table(UAV, "residuals"), REPORT=str(FOLDER / "orthoimage.html"))
    load()
    from make_sample import write_layers
    from uav_validation import comparison, lanes_in_the_image

    write_layers(UAV, {"lanes_in_image": lanes_in_the_image(UAV_IMAGE, geometries(UAV, "control_points"))})
    process("assessdrivinglines", INPUT=f"{PACKAGE}|layername=driving_lines", REFERENCE=f"{UAV}|layername=lanes_in_image",
            AREA=f"{PACKAGE}|layername=road_surface", OUTPUT=table(UAV, "driving_lines_by_outcome"), REPORT=str(FOLDER / "over_uav_image.html"))
    told, accuracy = comparison(geometries(PACKAGE, "driving_lines")[0], geometries(UAV, "lanes_in_image")[0],
                                geometries(TRUTH, "driving_lines")[0], road_area())
    if not accuracy.completeness[0.15] > 0.7:
        stop(f"driving lines agree with the UAV image by {percent(accuracy.completeness[0.15])} only.")
    return [f"{placed['POINTS']} control points, RMSE {100 * placed['RMSE']:.1f} cm, each left out in turn {100 * placed['LEFT_OUT_RMSE']:.1f} cm; "
            f"{placed['CHECK_POINTS']} check points, RMSE {100 * placed['CHECK_RMSE']:.1f} cm", *told]


def road_area():
    """The surveyed road with a metre beside it: the truth reaches as far as the street, the survey as far as the scanner saw it."""
    import shapely

    return shapely.union_all([g.buffer(0) for g in map(shapely.force_2d, geometries(PACKAGE, "road_surface")[0])]).buffer(1.0)


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for old in FOLDER.iterdir():
        if old.is_file():
            old.unlink()
    cloud, trajectory = FOLDER / "survey.laz", FOLDER / "trajectory.gpkg"
    process("samplesurvey", POINT_CLOUD=str(cloud), TRAJECTORY=str(trajectory),
            TRUTH_BOUNDARIES=table(TRUTH, "boundaries"), TRUTH_MARKINGS=table(TRUTH, "markings"),
            TRUTH_DRIVING_LINES=table(TRUTH, "driving_lines"), UAV_IMAGE=str(UAV_IMAGE), UAV_GCPS=table(UAV, "control_points"))
    image, road, report = FOLDER / "intensity.tif", FOLDER / "road_points.laz", FOLDER / "report.html"
    results = process("roadmap", POINT_CLOUDS=[str(cloud)], TRAJECTORY=str(trajectory), INTENSITY_IMAGE=str(image),
                      ROAD_POINTS=str(road), REPORT=str(report),
                      **{name.upper(): table(PACKAGE, name) for name in TABLES})
    absent = [name for name in (*map(str.upper, TABLES), "INTENSITY_IMAGE", "ROAD_POINTS", "REPORT") if not results.get(name)]
    if absent:
        stop(f"roadmap returned no {', '.join(absent)}.")
    picture, uav_picture = FOLDER / "map.png", FOLDER / "uav.png"
    validation = over_the_uav_image()
    drawn = subprocess.run([sys.executable, str(ROOT / "tools" / "draw_map.py"), str(PACKAGE), str(image), str(picture),
                            str(UAV), str(ORTHOIMAGE), str(uav_picture)])
    if drawn.returncode:
        stop("the maps could not be drawn.")
    check_results(image, road, report, picture)
    accuracy()
    print("\nDriving lines over the georeferenced UAV image, within (simulated data):")
    print("\n".join(f"  {line}" for line in validation))
    print("\nResults:")
    for path, what in ((PACKAGE, "all layers, styled"), (image, "intensity image"), (road, "road points"),
                       (report, "numbers of every stage"), (picture, "the map"), (ORTHOIMAGE, "UAV image on the map"),
                       (uav_picture, "driving lines over it")):
        print(f"  {path}  ({what})")


if __name__ == "__main__":
    main()
