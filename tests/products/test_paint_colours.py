"""White and yellow paint, by what a camera saw of it."""

import laspy
import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.common.features import MARKING_LINES, MARKINGS, Features
from lanewright.core.survey.las.reader import read_headers
from lanewright.products.cloud.colours import PaintColours, add_points, colours_of_lines

ORIGIN = np.array([440_000.0, 4_420_000.0])
PAINT = {"white": (235, 235, 228), "yellow": (214, 172, 72)}   # sRGB in daylight
ASPHALT = (96, 96, 94)
EDGE, CENTRE, HIDDEN, FAR = range(4)


def street():
    """A white edge line, a yellow centre line of two dashes, a dash below a parked car, and one beyond the picture."""
    boxes = [shapely.box(0, 0, 20, 0.12), shapely.box(0, 3.5, 6, 3.62), shapely.box(10, 3.5, 12, 3.62), shapely.box(0, 40, 6, 40.12)]
    markings = Features("PolygonZ", MARKINGS)
    for box in boxes:
        markings.add(shapely.transform(box, lambda places: places + ORIGIN), road=1, use="keep")
    return markings


def picture(light=(1.0, 1.0, 1.0), worn=0.0, seed=3):
    """Places of a camera over the street and their colours: paint is worn to asphalt by a share, and all is seen in a light."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-1, 21, 60_000), rng.uniform(-1, 5, 60_000)
    colours = np.tile(np.array(ASPHALT, float), (len(x), 1))
    for name, inside in (("white", (y > 0) & (y < 0.12) & (x > 0) & (x < 20)), ("yellow", (y > 3.5) & (y < 3.62) & (x > 0) & (x < 12))):
        colours[inside & (rng.random(len(x)) >= worn)] = PAINT[name]
    gap = (y > 3.5) & (y < 3.62) & (x > 6) & (x < 10)
    colours[gap] = ASPHALT
    colours[(x > 9.5) & (x < 12.5) & (y > 3.0) & (y < 4.1)] = 0   # nothing is seen below the car
    seen = colours * light * rng.uniform(0.7, 1.1, (len(x), 1)) + rng.normal(0, 6, colours.shape) * (colours > 0)
    return np.c_[x, y] + ORIGIN, np.clip(seen, 0, 255).astype(np.uint8)


@pytest.mark.parametrize("light", [(1.0, 1.0, 1.0), (1.0, 0.8, 0.55), (0.75, 0.85, 1.05)], ids=["daylight", "lamps", "shade"])
@pytest.mark.parametrize("worn", [0.0, 0.4])
def test_yellow_paint_is_yellow_in_any_light_and_what_nobody_saw_stays_open(light, worn):
    seen = PaintColours(street())
    places, colours = picture(light, worn)
    for rows in np.array_split(np.arange(len(places)), 3):
        seen.add(places[rows], colours[rows])
    assert seen.colours().tolist() == ["white", "yellow", "", ""]
    assert seen.seen[HIDDEN] == seen.seen[FAR] == 0


def test_a_line_has_the_colour_of_most_of_its_paint():
    markings, lines = street(), Features("LineStringZ", MARKING_LINES)
    for y in (0.06, 3.56, 40.06):
        lines.add(shapely.LineString([(ORIGIN[0] + x, ORIGIN[1] + y, 20.0) for x in (0, 20)]), road=1)
    seen = PaintColours(markings)
    seen.add(*picture())
    assert colours_of_lines(lines, markings, seen.colours()).tolist() == ["white", "yellow", ""]


def cloud(path, point_format):
    places, colours = picture()
    header = laspy.LasHeader(point_format=point_format, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.append(ORIGIN, 0.0)
    points = laspy.LasData(header)
    points.x, points.y, points.z = *places.T, np.zeros(len(places))
    if point_format == 7:
        points.red, points.green, points.blue = colours.astype(np.uint16).T * 257
    points.write(str(path))
    return read_headers([path])


def test_points_with_colours_show_them_and_points_without_are_refused(tmp_path):
    seen = PaintColours(street())
    add_points(seen, cloud(tmp_path / "coloured.laz", 7))
    assert seen.colours()[[EDGE, CENTRE]].tolist() == ["white", "yellow"]
    with pytest.raises(RoadExtractionError, match="have no colours"):
        add_points(seen, cloud(tmp_path / "grey.laz", 6))
