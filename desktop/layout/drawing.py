"""A drawing in millimetres, as a picture of a layout: lines, areas and texts that nothing evaluates; the legend of a sheet, and its charts."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterable
from html import escape

import numpy as np
import shapely
from qgis.core import (
    Qgis,
    QgsExpressionContextUtils,
    QgsLayerTreeModelLegendNode,
    QgsLayoutItemLegend,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsLayoutUtils,
    QgsLegendRenderer,
    QgsLegendSettings,
    QgsLegendStyle,
    QgsMapLayer,
    QgsMapLayerLegendUtils,
    QgsPrintLayout,
    QgsRenderContext,
    QgsSimpleLineSymbolLayer,
    QgsSymbolLegendNode,
    QgsTextFormat,
)
from qgis.PyQt.QtCore import QRectF, QSizeF
from qgis.PyQt.QtGui import QColor, QFont, QFontMetricsF
from scipy.spatial import cKDTree

from ...core.common.arrays import round_step
from ...processing_provider.texts import numbers, tr
from .axes import Axis, MapLine

LETTER = 0.353   # mm of a point
FINEST = 0.01    # mm by which a line may be drawn beside its places
GREY, DARK = "#8a8a8a", "#202020"


class Drawing:
    """Lines and texts on a rectangle of so many millimetres, y downwards."""

    def __init__(self, width: float, height: float):
        self.width, self.height = width, height
        self._parts: list[str] = []
        self._taken: list[QRectF] = []   # where texts stand

    def line(self, places: np.ndarray | list, colour: str = DARK, width: float = 0.2, dash: str = "", fill: str = "none",
             closed: bool = False) -> None:
        """A polyline through (N, 2) places; what is not finite interrupts it."""
        places = np.asarray(places, float)
        for part in np.split(places, np.flatnonzero(~np.isfinite(places).all(axis=1))):
            part = part[np.isfinite(part).all(axis=1)]
            if len(part) > 1:
                if not closed:
                    part = shapely.get_coordinates(shapely.simplify(shapely.linestrings(part), FINEST))
                path = "M" + "L".join(f"{x:.3f} {y:.3f}" for x, y in part) + "Z" * closed
                dashed = f' stroke-dasharray="{dash}"' if dash else ""
                faint = f' fill-opacity="{int(fill[7:], 16) / 255:.2f}"' if len(fill) == 9 else ""
                self._parts.append(f'<path d="{path}" fill="{fill[:7]}"{faint} stroke="{colour}" stroke-width="{width}"{dashed} '
                                   'stroke-linejoin="round"/>')

    def text(self, x: float, y: float, text: str, size: float = 7.0, anchor: str = "middle", turned: float = 0.0, colour: str = DARK,
             boxed: bool = False, yields: bool = False) -> bool:
        """A text whose middle line passes through a place, `turned` clockwise by degrees; False where it `yields` to texts already there."""
        text = numbers(text)
        wide, high = text_width(text, size), size * LETTER
        shift = {"start": wide / 2, "middle": 0.0, "end": -wide / 2}[anchor]
        angle = math.radians(turned)
        cx, cy = x + shift * math.cos(angle), y + shift * math.sin(angle)
        w = abs(wide * math.cos(angle)) + abs(high * math.sin(angle))
        h = abs(wide * math.sin(angle)) + abs(high * math.cos(angle))
        room = QRectF(cx - w / 2 - 0.4, cy - h / 2 - 0.3, w + 0.8, h + 0.6)
        if yields and (any(room.intersects(other) for other in self._taken) or not QRectF(0, 0, self.width, self.height).contains(room)):
            return False
        self._taken.append(room)
        turn = f' transform="rotate({turned:.2f} {cx:.3f} {cy:.3f})"' if turned else ""
        if boxed:
            self._parts.append(f'<rect x="{cx - wide / 2 - 0.5:.3f}" y="{cy - high * 0.62:.3f}" width="{wide + 1:.3f}" height="{high * 1.24:.3f}" '
                               f'fill="#ffffff" fill-opacity="0.85"{turn}/>')
        self._parts.append(f'<text x="{cx:.3f}" y="{cy + 0.36 * high:.3f}" font-family="{FONT}" font-size="{high:.3f}" text-anchor="middle" '
                           f'fill="{colour}"{turn}>{escape(text)}</text>')
        return True

    def path(self) -> str:
        """As QGIS takes a picture that lies in no file."""
        text = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}mm" height="{self.height}mm" '
                f'viewBox="0 0 {self.width} {self.height}">{"".join(self._parts)}</svg>')
        return "base64:" + base64.b64encode(text.encode()).decode()


def text_width(text: str, size: float) -> float:
    """mm that a text takes, letters of `size` points."""
    font = QFont(FONT)
    font.setPixelSize(100)
    return QFontMetricsF(font).horizontalAdvance(text) / 100 * size * LETTER


def station_text(station: float) -> str:
    """0+125 for 125 m, as on plans."""
    whole, rest = divmod(round(abs(station), 2), 1000)
    sign = "-" if station < 0 else ""
    return f"{sign}{int(whole)}+{rest:03.0f}" if rest == round(rest) else f"{sign}{int(whole)}+{rest:06.2f}"


# The legend of a sheet: the classes that a road map has, in as many columns as fit; and the letters of all that is printed.

TITLES, ENTRY = 12.0, 6.5        # mm: titles and margins of the legend, and each entry below a title
SIZES = ((8.0, 7.0, 4.0), (7.0, 6.0, 3.0), (6.0, 5.0, 2.0))  # letters of titles and entries, points, and symbols, mm: the first that fits
FONT = "DejaVu Sans"
DPI = 300.0                      # of the measurement; any would do
ASPHALT, WHITE, GROUND = QColor("#8d9299"), 200, 3.0   # of the road plan; lightness of paint; mm of asphalt below a painted line
STYLES = (QgsLegendStyle.Style.Title, QgsLegendStyle.Style.Group, QgsLegendStyle.Style.Subgroup, QgsLegendStyle.Style.Symbol,
          QgsLegendStyle.Style.SymbolLabel)


def text_format(size: float) -> QgsTextFormat:
    """The letters of a layout, in points."""
    style = QgsTextFormat()
    style.setFont(QFont(FONT))
    style.setSize(size)
    return style


def as_it_stands(text: str) -> str:
    """A text of others, such as the name of a survey or a CRS, for a layout, which would evaluate expressions between [% and %] in it."""
    return text.replace("[%", "[% '[%' %]")


def classes_by_layer(layers: list[QgsMapLayer]) -> dict[QgsMapLayer, set[str]]:
    """The layers of which a legend says something, lines, points and areas, with the keys of those classes of their style that some feature has."""
    return {layer: _classes_of(layer) for layer in layers
            if layer.type() == Qgis.LayerType.Vector and layer.isSpatial() and layer.featureCount() != 0}


def _classes_of(layer):
    context = QgsRenderContext()
    context.expressionContext().appendScopes(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
    renderer = layer.renderer().clone()
    renderer.startRender(context, layer.fields())
    keys: set[str] = set()
    for feature in layer.getFeatures():
        context.expressionContext().setFeature(feature)  # classes may be distinguished by an expression
        keys |= set(renderer.legendKeysForFeature(feature, context))
    renderer.stopRender(context)
    return keys


def legend_height(classes: dict[QgsMapLayer, set[str]]) -> float:
    """mm that the longest layer takes in the legend, with the classes there are."""
    return TITLES + ENTRY * max([1, *map(len, classes.values())])


def add_legend(layout: QgsPrintLayout, classes: dict[QgsMapLayer, set[str]], room: QRectF, page: int = 0) -> QgsLayoutItemLegend | None:
    """A legend in the upper left corner of `room` (mm) of a page; None, and nothing is added, where it does not fit.

    It lists the classes that there are, of `classes_by_layer`. QGIS's own filter by the map is not used for that: it looks through the layers
    in the background and has timers, which may outlive the layers, and how large the legend becomes is not known before.
    """
    legend = QgsLayoutItemLegend(layout)
    layout.addLayoutItem(legend)
    legend.attemptMove(QgsLayoutPoint(room.x(), room.y(), Qgis.LayoutUnit.Millimeters), page=page)
    legend.setAutoUpdateModel(False)
    root = legend.model().rootGroup()
    root.clear()
    for layer, keys in classes.items():
        _add_classes(legend, root.addLayer(layer), layer, keys)
    legend.setResizeToContents(False)  # by its own measure the last letters would stand beside its ground
    legend.setSplitLayer(False)
    legend.setEqualColumnWidth(False)
    legend.setColumnSpace(3)
    for title, entry, symbol in SIZES:
        legend.setSymbolHeight(symbol)
        for style in STYLES:
            legend_style = legend.style(style)
            legend_style.setTextFormat(text_format(entry if style == QgsLegendStyle.Style.SymbolLabel else title))
            legend.setStyle(style, legend_style)
        for columns in range(1, max(1, len(classes)) + 1):
            legend.setColumnCount(columns)
            size = _size(layout, legend)
            if size.height() <= room.height() and size.width() <= room.width():
                legend.attemptResize(QgsLayoutSize(size, Qgis.LayoutUnit.Millimeters))
                return legend
    layout.removeLayoutItem(legend)
    return None


def _size(layout, legend):
    """mm that a legend will take; it knows by itself only once it is drawn."""
    settings = QgsLegendSettings()
    for style in STYLES:
        settings.setStyle(style, legend.style(style))
    settings.setColumnCount(legend.columnCount())
    settings.setColumnSpace(legend.columnSpace())
    settings.setBoxSpace(legend.boxSpace())
    settings.setSymbolSize(QSizeF(legend.symbolWidth(), legend.symbolHeight()))
    return QgsLegendRenderer(legend.model(), settings).minimumSize(QgsLayoutUtils.createRenderContextForLayout(layout, None, DPI))


def _add_classes(legend, node, layer, keys):
    """List the classes with these keys; no expression in the names of a layer and of its classes is evaluated."""
    if "[%" in layer.name():
        node.setCustomProperty("legend/title-label", as_it_stands(layer.name()))
    key = QgsLayerTreeModelLegendNode.LegendNodeRoles.RuleKeyRole
    order = []
    for row, entry in enumerate(legend.model().layerOriginalLegendNodes(node)):
        if str(entry.data(key)) in keys:
            order.append(row)
        if isinstance(entry, QgsSymbolLegendNode):
            if "[%" in entry.symbolLabel():
                QgsMapLayerLegendUtils.setLegendNodeUserLabel(node, row, as_it_stands(entry.symbolLabel()))
            QgsMapLayerLegendUtils.setLegendNodeCustomSymbol(node, row, _on_asphalt(entry.symbol()))
    if order:
        QgsMapLayerLegendUtils.setLegendNodeOrder(node, order)
    legend.model().refreshLayerLegend(node)


def _on_asphalt(symbol):
    """The symbol of a class; that of white paint on the grey it lies on, for on white paper it would not be seen."""
    shown = symbol.clone()
    tones = [part.color().lightness() for part in shown.symbolLayers()]
    if max(tones) < WHITE or min(tones) < ASPHALT.lightness() - 10:
        return shown
    if symbol.type() == Qgis.SymbolType.Line:
        shown.insertSymbolLayer(0, QgsSimpleLineSymbolLayer(ASPHALT, GROUND))
    return shown


# Longitudinal profiles along the axes and cross-sections of the road, drawn to scale on pages.

EXAGGERATIONS = (10, 5, 2, 1)   # heights of a profile are drawn so many times as large as lengths
REDUCED = (1, 2, 4)   # times smaller than the plan that a profile may be: the first scale at which a page shows PER_PAGE sheets
PER_PAGE = 3
FREE = 14.0           # mm of height above and below the relief of a strip
TABLE = 30.0          # mm below it for stations, heights and gradients
LEFT = 24.0           # mm for captions and heights left of a drawing
SECTIONS = "CROSS_SECTIONS"
REASON = 2.6          # mm between lines of text on the limits that a section does not keep
TANGENT = 0.03        # m that a height may miss the tangents whose gradients are written
COLUMN = 5.0          # mm between heights in the table at least
SECTION_SCALES = (100, 200, 250, 500)   # of offsets
SECTION_HEIGHTS = 5   # times as large as offsets
SECTION_WIDTH = 170.0   # mm of page width for a section at least
SIDE = 3.0            # m of ground beside the outermost line of a section
THICKNESS = 0.3       # m along the road that a section takes points from
CELL = 0.05           # m of offset for which the ground is one median
HOLE = 0.4            # m without points that no line of the ground bridges
FEWEST = 3            # points of a median
COLOURS = {"ROAD_EDGES": "#e31a1c", "MARKING_LINES": "#2166ff", "DRIVING_LINES": "#00a651"}


def profile_pages(axes: list[Axis], width: float, height: float, scale: int, sheets: int) -> list[tuple[Drawing, str]]:
    """Drawings on pages of so many mm, strips of the profile of what so many sheets of a scale show, and the words of each one's scale."""
    axes = [known for axis in axes if (known := axis.with_heights()) is not None]
    if not axes:
        return []
    for along, times in ((scale * reduced, times) for reduced in REDUCED for times in EXAGGERATIONS[:2]):
        stretches, strip = _stretches(axes, width, along, times)
        if strip <= height and math.ceil(len(stretches) / (height // strip)) <= math.ceil(sheets / PER_PAGE):
            break
    while strip > height and times > EXAGGERATIONS[-1]:
        times = EXAGGERATIONS[EXAGGERATIONS.index(times) + 1]
        stretches, strip = _stretches(axes, width, along, times)
    count = max(int(height // strip), 1)
    strip = min(height / min(count, len(stretches)), 1.3 * strip)
    pages = []
    for start in range(0, len(stretches), count):
        drawing = Drawing(width, strip * len(stretches[start:start + count]))
        for row, stretch in enumerate(stretches[start:start + count]):
            _draw_profile(drawing, *stretch, row * strip, strip, along, times, len(axes) > 1)
        pages.append((drawing, tr("lengths 1 : {lengths}, heights 1 : {heights}").format(lengths=along, heights=f"{along / times:.0f}")))
    return pages


def _stretches(axes, width, scale, times):
    """[(axis, first, last station)] that fit the width of a page, and mm of height that the one with the greatest relief takes."""
    reach = max(math.floor((width - LEFT - 4) / 1000 * scale / 10) * 10, 10)
    stretches = [(axis, first, min(first + reach, axis.stations[-1])) for axis in axes
                 for first in np.arange(math.floor(axis.stations[0] / 10) * 10, axis.stations[-1] - 1e-6, reach)]
    stretches = [(axis, max(first, axis.stations[0]), last) for axis, first, last in stretches]
    relief = max(np.ptp(axis.at(_stations(first, last))[:, 2]) for axis, first, last in stretches)
    return stretches, relief * 1000 / scale * times + 16 + FREE + TABLE


def _stations(first, last, step=1.0):
    return np.unique(np.r_[first, np.arange(math.ceil(first / step) * step, last, step), last])


def _draw_profile(drawing, axis, first, last, top, strip, scale, times, named):
    per_mm, per_mm_up = scale / 1000, scale / 1000 / times
    stations = _stations(first, last)
    heights = axis.at(stations)[:, 2]
    base = top + strip - TABLE
    least = round_step(8 * per_mm_up)
    datum = math.floor((heights.min() - 3 * per_mm_up) / least) * least
    x_of = lambda station: LEFT + (np.asarray(station) - first) / per_mm  # noqa: E731
    y_of = lambda z: base - (np.asarray(z) - datum) / per_mm_up  # noqa: E731
    right = float(x_of(last))
    name = tr("Road {number}").format(number=axis.road) + ", " if named else ""
    drawing.text(LEFT, top + 5, f"{name}{station_text(first)} – {station_text(last)}", 9.0, "start")
    for z in np.arange(datum, heights.max() + least, least):
        y = float(y_of(z))
        if y > top + 9:
            drawing.line([(LEFT, y), (right, y)], "#c8c8c8", 0.1)
            drawing.text(LEFT - 1.5, y - (1.5 if z == datum else 0), f"{z:.{0 if least >= 1 else 1 if least >= 0.1 else 2}f}", 6.0, "end")
    drawing.text(1, base + 2.6, tr("Datum {height:.2f} m").format(height=datum), 5.0, "start", colour=GREY)
    drawing.line([(LEFT, top + 9), (LEFT, top + strip - 2), (right, top + strip - 2), (right, top + 9)], width=0.2)
    rows = base + np.array([0.0, 13.0, 21.0, 28.0])
    for y in rows[:3]:
        drawing.line([(1, y), (right, y)], width=0.2)
    for y, caption in zip((rows[:-1] + rows[1:]) / 2, (tr("Height (m)"), tr("Gradient"), tr("Station"))):
        drawing.text(LEFT - 1.5, float(y) + (1.4 if caption == tr("Height (m)") else 0), caption, 6.0, "end")
    step = next(step for step in (5, 10, 20, 50, 100, 200, 500, 1000) if step / per_mm >= COLUMN)
    label = next(step * times for times in (1, 2, 5, 10, 20) if step * times / per_mm >= 16)
    for station in _stations(first, last, step):
        if any(0 < abs(station - end) / per_mm < COLUMN * 0.7 for end in (first, last)):
            continue
        x, z = float(x_of(station)), float(axis.at(np.array([station]))[0, 2])
        drawing.line([(x, base), (x, float(y_of(z)))], "#c8c8c8", 0.1)
        drawing.text(x if last - station > 1e-6 else x - 1.6, (rows[0] + rows[1]) / 2, f"{z:.2f}", 6.0, turned=-90, yields=True)
        if abs(station / label - round(station / label)) < 1e-6:
            drawing.line([(x, rows[2]), (x, rows[2] + 1.5)], width=0.2)
            drawing.text(x, rows[2] + 4, station_text(station), 6.0, yields=True)
    drawing.line(np.c_[x_of(stations), y_of(heights)], "#b00020", 0.35)
    knees = shapely.get_coordinates(shapely.simplify(shapely.linestrings(np.c_[stations, heights]), TANGENT))
    for (s, z), (s2, z2) in zip(knees[:-1], knees[1:]):
        x, x2 = float(x_of(s)), float(x_of(s2))
        drawing.line([(x, rows[1]), (x, rows[2])], width=0.15)
        rise = 1.6 * np.sign(z2 - z)
        drawing.line([(x, (rows[1] + rows[2]) / 2 + rise), (x2, (rows[1] + rows[2]) / 2 - rise)], GREY, 0.15)
        text = f"{100 * (z2 - z) / (s2 - s):+.2f} %"
        for words in (f"{text} / {s2 - s:.0f} m", text):
            if 0.353 * 6 * 0.62 * len(words) < x2 - x - 1:
                drawing.text((x + x2) / 2, (rows[1] + rows[2]) / 2, words, 6.0, boxed=True)
                break


# -- cross-sections ------------------------------------------------------------------------


def section_pages(axes: list[Axis], lines: list[MapLine], ground: Iterable[np.ndarray], interval: float, width: float,
                  height: float) -> list[tuple[Drawing, str]]:
    """Drawings on pages of so many mm, a section every so many metres of every axis where there is a line or a point; and the words of their scale.

    Where there is a layer of cross-sections, its own are shown: those that are so far apart, and those in which a limit is not kept.
    """
    measured = [line for line in lines if line.output == SECTIONS]
    places = _measured_places(axes, measured, interval) if measured else [
        # at an end of the road just within it, so that its lines are crossed
        (axis, float(station), (*axis.at(np.clip([station], *axis.stations[[0, -1]] + [1e-3, -1e-3]))[0, :2], axis.heading(station)), (), None)
        for axis in axes for station in np.arange(math.ceil(axis.stations[0] / interval) * interval, axis.stations[-1] + 1e-6, interval)]
    if not places:
        return []
    planes = np.array([plane for _, _, plane, _, _ in places])
    reach = max(axis.half_width for axis in axes) + SIDE
    crossed = _crossings(planes, [line for line in lines if line.output != SECTIONS], reach)
    surfaces = [seen if len(seen) or profile is None else profile for seen, (*_, profile) in zip(_surfaces(planes, ground, reach), places)]
    heights = [_heights(*pair) for pair in zip(crossed, surfaces)]
    seen = [k for k, of_section in enumerate(heights) if len(of_section)]
    if not seen:
        return []
    columns = max(int(width // SECTION_WIDTH), 1)
    cell = width / columns
    scale = next((scale for scale in SECTION_SCALES if 2 * reach * 1000 / scale <= cell - LEFT - 4), SECTION_SCALES[-1])
    up = scale / SECTION_HEIGHTS
    head = 8 + REASON * max(max(len(places[k][3]) for k in seen) - 2, 0)
    tall = min(max(max(np.ptp(heights[k]) for k in seen) * 1000 / up, 12.0) + 18 + head, height)
    rows = max(int(height // tall), 1)
    tall, pages = height / rows, []
    for start in range(0, len(seen), rows * columns):
        shown = seen[start:start + rows * columns]
        below = math.ceil(len(shown) / columns)
        drawing = Drawing(width, below * tall)
        for number, k in enumerate(shown):
            column, row = divmod(number, below)
            axis, station, _, reasons, _ = places[k]
            name = f"{tr('Road {number}').format(number=axis.road)}, {station_text(station)}" if len(axes) > 1 else station_text(station)
            _draw_section(drawing, column * cell, row * tall, cell, tall, head, name, crossed[k], surfaces[k], scale, up, reach)
            for line, reason in enumerate(reasons):
                drawing.text(column * cell + 6 + text_width(name, 9.0), row * tall + 3 + REASON * line, reason, 6.0, "start", colour="#b00020")
        pages.append((drawing, tr("offsets 1 : {offsets}, heights 1 : {heights}").format(offsets=scale, heights=f"{up:g}")))
    return pages


def _measured_places(axes, lines, interval):
    """[(axis, station, (x, y, heading), limits that are not kept, (K, 2) offset and height)] of the sections of a layer."""
    sections: dict = {}
    for line in lines:
        sections.setdefault((line.row.get("road"), line.row.get("section")), []).append(line)
    result, shown = [], {}
    for (road, _), parts in sections.items():
        station, whole = parts[0].number("station"), max((part.places for part in parts), key=lambda places: np.ptp(places[:, :2], axis=0).max())
        reasons = [f"{part.row['lane'] if isinstance(part.row.get('lane'), int) else tr('carriageway')}: {reason}" for part in parts
                   if isinstance(part.row.get("why"), str) for reason in part.row["why"].split("; ")]
        across = (whole[0] - whole[-1])[:2] / np.hypot(*(whole[0] - whole[-1])[:2])   # to the left
        away, axis = min(((np.hypot(*(axis.places - whole.mean(0))[:, :2].T).min(), axis) for axis in axes), key=lambda pair: pair[0])
        if away > axis.half_width + SIDE or not reasons and station - shown.get(road, -math.inf) < interval - 1e-6:
            continue
        shown[road] = station
        nearest = axis.places[np.argmin(np.hypot(*(axis.places - whole.mean(0))[:, :2].T)), :2]
        place = whole[0, :2] + (nearest - whole[0, :2]) @ across * across
        result.append((axis, station, (*place, math.atan2(-across[0], across[1])), reasons, np.c_[(whole[:, :2] - place) @ across, whole[:, 2]]))
    return result


def _crossings(planes, lines, reach):
    """For each plane its (offset, z, result, height of a curb above it or NaN), from left to right."""
    shapes = [shapely.LineString(line.places[:, :2]) for line in lines]
    tree = shapely.STRtree(shapes)
    result = []
    for x, y, heading in planes:
        left = np.array([-math.sin(heading), math.cos(heading)])
        cut = shapely.LineString(np.array([x, y]) + np.outer([reach, -reach], left))
        crossings = []
        for k in tree.query(cut, predicate="intersects") if shapes else ():
            line = lines[k]
            along = np.append(0.0, np.cumsum(np.hypot(*np.diff(line.places[:, :2], axis=0).T)))
            for place in shapely.get_coordinates(shapely.intersection(cut, shapes[k])):
                z = float(np.interp(shapes[k].project(shapely.Point(place)), along, line.places[:, 2]))
                curb = line.row.get("edge") != "pavement" and line.row.get("part") != "top" and line.output == "ROAD_EDGES"
                crossings.append((float((place - (x, y)) @ left), z, line.output, line.number("height") if curb else math.nan))
        result.append(sorted((one for one in crossings if math.isfinite(one[1])), key=lambda one: -one[0]))
    return result


def _surfaces(planes, ground, reach):
    """For each plane (K, 2) offset and height of the ground, by medians of the points; NaN where there are none."""
    tree, kept = cKDTree(planes[:, :2]), [np.empty((0, 3))]
    cos, sin = np.cos(planes[:, 2]), np.sin(planes[:, 2])
    for block in ground:
        nearest = tree.query(block[:, :2], distance_upper_bound=reach)[1]
        block, nearest = block[nearest < len(planes)], nearest[nearest < len(planes)]
        delta = block[:, :2] - planes[nearest, :2]
        along = delta[:, 0] * cos[nearest] + delta[:, 1] * sin[nearest]
        across = delta[:, 1] * cos[nearest] - delta[:, 0] * sin[nearest]
        rows = np.abs(along) <= THICKNESS / 2
        kept.append(np.c_[nearest, across, block[:, 2]][rows])
    points = np.concatenate(kept)
    return [_profile(points[points[:, 0] == k, 1:]) for k in range(len(planes))]


def _profile(points):
    cells = np.floor(points[:, 0] / CELL).astype(int)
    profile = np.array([((cell + 0.5) * CELL, np.median(heights)) for cell in np.unique(cells)
                        if len(heights := points[cells == cell, 1]) >= FEWEST]).reshape(-1, 2)
    return np.insert(profile, np.flatnonzero(np.diff(profile[:, 0]) > HOLE) + 1, np.nan, axis=0)


def _heights(crossings, surface):
    tops = [z + curb for _, z, _, curb in crossings if math.isfinite(curb)]
    return np.r_[[z for _, z, _, _ in crossings], tops, surface[np.isfinite(surface[:, 1]), 1]]


def _draw_section(drawing, left, top, wide, tall, head, name, crossings, surface, scale, up, reach):
    per_mm, per_mm_up = scale / 1000, up / 1000
    middle, base = left + LEFT + (wide - LEFT - 4) / 2, top + tall - 12
    drawing.text(left + 3, top + 4, name, 9.0, "start")
    heights = _heights(crossings, surface)
    step = round_step(7 * per_mm_up)
    datum = math.floor(heights.min() / step - 0.2) * step
    x_of = lambda offset: middle - np.asarray(offset) / per_mm  # noqa: E731
    y_of = lambda z: base - (np.asarray(z) - datum) / per_mm_up  # noqa: E731
    low, high = middle - reach / per_mm, middle + reach / per_mm
    for z in np.arange(datum, datum + (base - top - head) * per_mm_up, step):
        drawing.line([(low, float(y_of(z))), (high, float(y_of(z)))], "#c8c8c8", 0.1)
        drawing.text(low - 1, float(y_of(z)), f"{z:.{1 if step >= 0.1 else 2}f}", 5.5, "end")
    across = round_step(9 * per_mm)
    for offset in np.arange(-math.floor(reach / across), math.floor(reach / across) + 1) * across:
        x = float(x_of(offset))
        drawing.line([(x, base), (x, top + head)], "#b00020" if offset == 0 else "#c8c8c8", 0.15 if offset == 0 else 0.1)
        drawing.text(x, base + 2.2, f"{offset + 0.0:g}", 5.5)
    road = np.array([(offset, z) for offset, z, _, _ in crossings]).reshape(-1, 2)
    ground = surface if len(surface) else road
    drawing.line(np.c_[x_of(ground[:, 0]), y_of(ground[:, 1])], DARK, 0.25)
    for offset, z, output, curb in crossings:
        x, y = float(x_of(offset)), float(y_of(z))
        size = 0.45
        if output == "ROAD_EDGES" and math.isfinite(curb):
            drawing.line([(x, y), (x, float(y_of(z + curb)))], COLOURS[output], 0.5)
        drawing.line([(x - size, y - size), (x + size, y - size), (x + size, y + size), (x - size, y + size)], COLOURS.get(output, GREY), 0.1,
                     fill=COLOURS.get(output, GREY), closed=True)
    for offset, z, output, _ in sorted(crossings, key=lambda one: one[2] != "ROAD_EDGES"):
        if output != "DRIVING_LINES":
            drawing.text(float(x_of(offset)), base + 7, f"{z:.2f}", 5.0, turned=-90, yields=True, colour=COLOURS.get(output, GREY))
