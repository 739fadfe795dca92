"""Pages along a road that is too long for one: rectangles of one size, each turned so that the road runs along it."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.core import QgsGeometry, QgsPointXY, QgsRectangle

OVERLAP = 0.08      # of a page that the next one shows again
MOST_PAGES = 500    # an atlas of more would take hours to draw
SHORTEST_REST = 0.1  # of a page: shorter uncovered rests of lines get no page of their own


@dataclass(frozen=True)
class MapPage:
    """One page: its outline in map coordinates and the angle of the road on it, degrees clockwise from east."""

    outline: QgsGeometry
    centre: QgsPointXY
    angle: float


def pages_along(lines: list[QgsGeometry], width: float, height: float) -> list[MapPage]:
    """Pages that show all of the lines.

    lines : line geometries, in metres
    width, height : of the ground that a page shows, metres, width along the road
    Returns list of MapPage in the order in which the lines are walked along, the longest line first
    """
    lines = [line for line in lines if line is not None and not line.isEmpty()]
    if not lines:
        return []
    left = QgsGeometry.unaryUnion(lines).mergeLines()
    pages: list[MapPage] = []
    while len(pages) < MOST_PAGES:
        parts = [part for part in left.asGeometryCollection() if part.length() > (SHORTEST_REST * width if pages else 0.0)]
        if not parts:
            break
        new_pages = _walk(max(parts, key=lambda part: part.length()), width, height)
        pages += new_pages[:MOST_PAGES - len(pages)]
        left = left.difference(QgsGeometry.unaryUnion([page.outline for page in new_pages]))
    return pages


def _walk(line: QgsGeometry, width: float, height: float) -> list[MapPage]:
    """Pages along one line; each reaches as far as the line stays on it."""
    pages, begin, length = [], 0.0, line.length()
    while begin < length - 1e-6:
        reach = width * (1 - OVERLAP)
        while True:
            end = min(begin + reach, length)
            page = _page(_between(line, begin, end), width, height)
            if page is not None or reach < 0.2 * width:
                break
            reach *= 0.8
        if page is None:  # a loop tighter than a page is high: its middle is shown
            page = _page(_between(line, begin, end), width, height, fits=False)
        pages.append(page)
        begin = end
    return pages


def _between(line: QgsGeometry, begin: float, end: float) -> list[QgsPointXY]:
    """Places every twentieth of the way from `begin` to `end` along a line."""
    return [line.interpolate(begin + (end - begin) * k / 20).asPoint() for k in range(21)]


def _page(places: list[QgsPointXY], width: float, height: float, fits: bool = True) -> MapPage | None:
    """The page turned by the chord of these places; None where they do not fit on it."""
    chord = places[0].azimuth(places[-1]) if places[0].distance(places[-1]) > 0 else 90.0
    angle = chord - 90.0
    turned = QgsGeometry.fromPolylineXY(places)
    turned.rotate(-angle, places[0])
    box = turned.boundingBox()
    if fits and (box.width() > width * (1 - OVERLAP / 2) or box.height() > height * 0.7):
        return None
    outline = QgsGeometry.fromRect(QgsRectangle.fromCenterAndSize(box.center(), width, height))
    outline.rotate(angle, places[0])
    # turned upside down a map is hard to read
    upright = (angle + 90.0) % 180.0 - 90.0
    return MapPage(outline, outline.centroid().asPoint(), upright)
