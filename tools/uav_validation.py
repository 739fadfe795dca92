"""Driving lines over a georeferenced UAV image of the sample survey: the validation of the demo.

The reference is the middle of every true lane as it is seen in the georeferenced image. Each is taken to the pixels
by the true distortion of the camera, and from there to the map by the polynomial that was estimated from the control points: what
somebody would draw over the image who points without error. So errors of the image count as they do on a
real one, and errors of pointing do not.
"""

import numpy as np
import shapely

TOLERANCES = (0.05, 0.10, 0.15, 0.20)  # m, half-widths of the buffer


def lanes_in_the_image(image_path, control_points):
    """Features of the true lane centres as the georeferenced image of the sample survey shows them.

    Parameters
    ----------
    image_path : of the UAV image, without a place on the map
    control_points : (geometries, rows) of its control point layer
    """
    from lanewright.core.common.features import Features
    from lanewright.products.overlay.control_points import control_points as points_of
    from lanewright.products.overlay.control_points import open_image
    from lanewright.products.overlay.georeference import georeference
    from lanewright.simulator.survey import make_sample_survey

    survey = make_sample_survey()
    image = open_image(image_path)
    names = ("point", "role", "pixel", "line", "mapX", "mapY")
    rows = [[row[name] for name in names[:4]] + [place.x, place.y] for place, row in zip(*control_points)]
    polynomial = georeference(image, points_of(names, rows, image, "The control points", survey.crs)).fit.polynomial
    lines = survey.truth_driving_lines
    seen = Features(lines.geometry_type, lines.schema, crs=lines.crs)
    for line, row in lines:
        seen.add(shapely.transform(line, lambda places: _as_seen(places, survey, polynomial), include_z=True), **row)
    return seen


def _as_seen(places, survey, polynomial):
    x, y = places[:, :2].T - np.array(survey.settings.origin[:2])[:, None]
    return np.column_stack([*polynomial.to_map(*survey.camera.to_pixel(x, y)), places[:, 2]])


def comparison(result, reference, truth, area):
    """Lines of text: recall and miscoding within each tolerance, against what the image shows and against the truth."""
    from lanewright.products.assess.lines import compare_lines

    over_image, exact = (compare_lines(result, lines, TOLERANCES, area=area) for lines in (reference, truth))
    image_alone = compare_lines(reference, truth, TOLERANCES)
    told = [f"{'':14}" + "".join(f"{100 * tolerance:10.0f} cm" for tolerance in TOLERANCES)]
    for name, shares in (("recall", over_image.completeness), ("miscoding", {t: 1 - c for t, c in over_image.correctness.items()})):
        told.append(f"{name:14}" + "".join(f"{100 * shares[tolerance]:11.1f} %" for tolerance in TOLERANCES))
    over, against, alone = (100 * accuracy.lateral.rmse for accuracy in (over_image, exact, image_alone))
    told.append(f"RMSE across {over:.1f} cm over the image, {against:.1f} cm against the truth; "
                f"the image itself is {alone:.1f} cm off along the lanes")
    return told, over_image
