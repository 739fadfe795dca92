"""A print layout of a road map: A4 or A3, a round scale, legend, scale bar and north arrow; an atlas where the road is long."""

from __future__ import annotations

import math
from dataclasses import dataclass

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsExpressionContextUtils,
    QgsFeature,
    QgsGeometry,
    QgsLayerTreeLayer,
    QgsLayerTreeModelLegendNode,
    QgsLayoutItemLabel,
    QgsLayoutItemLegend,
    QgsLayoutItemMap,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsLayoutObject,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsLayoutUtils,
    QgsLegendRenderer,
    QgsLegendSettings,
    QgsLegendStyle,
    QgsMapLayer,
    QgsMapLayerLegendUtils,
    QgsPointXY,
    QgsPrintLayout,
    QgsProject,
    QgsProperty,
    QgsRectangle,
    QgsRenderContext,
    QgsSymbolLegendNode,
    QgsTextFormat,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QRectF, QSizeF, Qt
from qgis.PyQt.QtGui import QColor, QFont

from ...processing_provider.texts import tr

PAPERS = {"A4": (297.0, 210.0), "A3": (420.0, 297.0)}  # mm, landscape
BORDER, HEADING = 8.0, 10.0   # mm: rim of the page, and the line of the title
MOST_LEGEND = 0.4             # of the page's height
MARGIN = 4.0                  # m of ground around the road
ARROW = 12.0                  # mm
SCALES = (100, 200, 250, 500, 1000, 2000, 2500, 5000, 10_000, 20_000, 25_000, 50_000, 100_000)
ATLAS_FROM = 1000             # smaller scales show no lane any more: the road is divided into pages of 1:ATLAS_SCALE
ATLAS_SCALE = 500
NORTH_ARROW = ":/images/north_arrows/layout_default_north_arrow.svg"  # of QGIS itself


@dataclass(frozen=True)
class Frame:
    """The page and the map on it, mm."""

    page_width: float
    page_height: float
    map_height: float

    @property
    def map_width(self) -> float:
        return self.page_width - 2 * BORDER


def road_map_layout(project: QgsProject, layers: list[QgsMapLayer], title: str, paper: str = "A4",
                    below: list[QgsMapLayer] | None = None, scale: int = 0, credit: str = "") -> QgsPrintLayout:
    """A layout with the road along the page.

    Parameters
    ----------
    project : QgsProject that will own the layout
    layers : its layers from above
    title : what stands over the map
    paper : "A4" or "A3"; landscape or portrait, whichever shows the road larger
    below : layers drawn below these and left out of the legend: an orthoimage, a web map
    scale : denominator of the scale; 0 takes the largest round scale at which the whole road fits,
        and an atlas of pages of 1 : 500 where that would be smaller than 1 : 1000
    credit : whose data lie below, as their licence wants it said on the map

    Returns QgsPrintLayout, not yet added to the project's layouts.
    """
    crs = map_crs(layers, project)
    centre, angle, length, width = lie_of_the_road(layers, crs, project)
    legend = legend_height(layers)
    frame, fitting = _largest(paper, legend, length + 2 * MARGIN, width + 2 * MARGIN)
    layout = QgsPrintLayout(project)
    layout.initializeDefaults()
    layout.setName(title)
    layout.pageCollection().page(0).setPageSize(QgsLayoutSize(frame.page_width, frame.page_height, Qgis.LayoutUnit.Millimeters))
    pages: list[MapPage] = []
    if scale or fitting > ATLAS_FROM:
        shown = scale or ATLAS_SCALE
        if shown < fitting:
            pages = pages_along(_lines(layers, crs, project), frame.map_width / 1000 * shown, frame.map_height / 1000 * shown)
    else:
        shown = fitting
    chart = _add_map(layout, [*layers, *(below or [])], crs, frame, centre, angle, shown)
    _add_heading(layout, title, crs, frame, atlas=len(pages) > 1)
    below_map = BORDER + HEADING + frame.map_height + 2
    add_legend(layout, layers, QRectF(BORDER, below_map, frame.map_width, frame.page_height - BORDER / 2 - below_map))
    _add_scale_bar(layout, chart, frame, shown)
    _add_north_arrow(layout, chart, frame)
    if credit:
        _add_credit(layout, frame, credit)
    if len(pages) > 1:
        _add_atlas(project, layout, chart, pages, crs, title)
    return layout


def map_crs(layers: list[QgsMapLayer], project: QgsProject) -> QgsCoordinateReferenceSystem:
    """The CRS that the map is drawn in: that of the first layer with a projected one, whatever the project shows."""
    all_crs = [layer.crs() for layer in layers if layer.isSpatial() and layer.crs().isValid()]
    return next((crs for crs in all_crs if not crs.isGeographic()), all_crs[0] if all_crs else project.crs())


def lie_of_the_road(layers: list[QgsMapLayer], crs: QgsCoordinateReferenceSystem | None = None, project: QgsProject | None = None) -> tuple:
    """Centre, angle to the page (degrees), length and width of the rectangle around the road, in the map's CRS.

    Of the road's surface where it is among the layers, or of whatever is drawn.
    """
    vectors = [layer for layer in layers if layer.type() == Qgis.LayerType.Vector and layer.isSpatial()]
    surfaces = [layer for layer in vectors if layer.geometryType() == Qgis.GeometryType.Polygon and "surface" in layer.source()]
    hulls = [hull for layer in surfaces or vectors for hull in _on_the_map(layer, crs, project, QgsGeometry.convexHull)]
    whole = QgsGeometry.collectGeometry([hull for hull in hulls if not hull.isEmpty()])
    if whole.isEmpty():
        whole = QgsGeometry.fromRect(layers[-1].extent())
    box, _, angle, width, height = whole.orientedMinimumBoundingBox()
    if height > width:
        width, height, angle = height, width, angle - 90.0
    # Angles are clockwise from north, of the box's shorter or longer side alike: bring them near zero
    return box.centroid().asPoint(), (angle + 90.0) % 180.0 - 90.0, width, height


def _on_the_map(layer, crs, project, of=QgsGeometry) -> list[QgsGeometry]:
    """`of` every geometry of a layer, in the CRS of the map; what cannot be transformed is left out."""
    transform = None
    if crs is not None and layer.crs().isValid() and layer.crs() != crs:
        transform = QgsCoordinateTransform(layer.crs(), crs, project or QgsProject.instance())
    result = []
    for feature in layer.getFeatures():
        if not feature.hasGeometry():
            continue
        geometry = of(feature.geometry())
        if transform is not None:
            try:
                geometry.transform(transform)
            except QgsCsException:
                continue
        result.append(geometry)
    return result


def _lines(layers, crs, project) -> list[QgsGeometry]:
    """What pages are laid along: driving lines where there are any, else marking lines, else edges, else all lines."""
    lines = [layer for layer in layers if layer.type() == Qgis.LayerType.Vector and layer.isSpatial()
             and layer.geometryType() == Qgis.GeometryType.Line]
    for word in ("driving", "marking", "edge"):
        chosen = [layer for layer in lines if word in f"{layer.source()} {layer.name()}".lower() and layer.featureCount()]
        if chosen:
            lines = chosen[:1]
            break
    return [geometry for layer in lines for geometry in _on_the_map(layer, crs, project)]


def _largest(paper: str, legend: float, length: float, width: float) -> tuple[Frame, int]:
    """The frame, landscape or portrait, that shows the road largest, and the round scale at which all of it fits."""
    long, short = PAPERS[paper]
    best = None
    for page_width, page_height in ((long, short), (short, long)):
        map_height = page_height - 2 * BORDER - HEADING - min(legend, MOST_LEGEND * page_height)
        frame = Frame(page_width, page_height, map_height)
        needed = max(length / frame.map_width, width / map_height) * 1000
        fitting = next((scale for scale in SCALES if scale >= needed), int(needed) + 1)
        if best is None or fitting < best[1]:
            best = frame, fitting
    return best


def _place(layout, item, x, y, width=None, height=None):
    layout.addLayoutItem(item)
    item.attemptMove(QgsLayoutPoint(x, y, Qgis.LayoutUnit.Millimeters))
    if width:
        item.attemptResize(QgsLayoutSize(width, height, Qgis.LayoutUnit.Millimeters))


def _boxed(item, opacity):
    """A white box behind an item."""
    item.setBackgroundEnabled(True)
    item.setBackgroundColor(QColor(255, 255, 255, opacity))


def _label(layout, text, size, side=Qt.AlignmentFlag.AlignLeft):
    label = QgsLayoutItemLabel(layout)
    label.setText(text)
    label.setTextFormat(text_format(size))
    label.setHAlign(side)
    label.setVAlign(Qt.AlignmentFlag.AlignVCenter)
    return label


def _add_map(layout, layers, crs, frame, centre, angle, scale):
    chart = QgsLayoutItemMap(layout)
    chart.setId("Map")
    _place(layout, chart, BORDER, BORDER + HEADING, frame.map_width, frame.map_height)
    chart.setCrs(crs)
    chart.setLayers(layers)
    width, height = frame.map_width / 1000 * scale, frame.map_height / 1000 * scale
    chart.zoomToExtent(QgsRectangle.fromCenterAndSize(centre, width, height))
    chart.setScale(scale)
    chart.setMapRotation(-angle)
    chart.setBackgroundColor(QColor(255, 255, 255))
    chart.setFrameEnabled(True)
    return chart


def _add_heading(layout, title, crs, frame, atlas):
    """The title, and on the right the CRS of the map and the page of an atlas."""
    page = ", " + tr("page") + " [% @atlas_featurenumber %] / [% @atlas_totalfeatures %]" if atlas else ""
    right = as_it_stands(crs.userFriendlyIdentifier()) + page
    for text, size, side in ((as_it_stands(title), 13, Qt.AlignmentFlag.AlignLeft), (right, 8, Qt.AlignmentFlag.AlignRight)):
        _place(layout, _label(layout, text, size, side), BORDER, BORDER - 1, frame.map_width, HEADING - 1)


def _add_scale_bar(layout, chart, frame, scale):
    """In the lower right corner of the map, with the scale as a number."""
    bar = QgsLayoutItemScaleBar(layout)
    bar.setStyle("Single Box")
    bar.setLinkedMap(chart)
    bar.setUnits(Qgis.DistanceUnit.Meters)
    bar.setUnitLabel("m")
    bar.setNumberOfSegments(4)
    bar.setNumberOfSegmentsLeft(0)
    # Four segments in an eighth to a quarter of the page
    least = frame.map_width / 1000 * scale / 40
    bar.setUnitsPerSegment(next(step * 10**power for power in range(7) for step in (1, 2, 5) if step * 10**power >= least))
    bar.setTextFormat(text_format(7))
    bar.setHeight(2)
    _boxed(bar, 225)
    bar.update()
    bottom = BORDER + HEADING + frame.map_height
    _place(layout, bar, BORDER + frame.map_width - bar.rect().width() - 3, bottom - bar.rect().height() - 3)
    number = _label(layout, "1 : [% format_number(round(item_variables('Map')['map_scale'] / 10) * 10, 0) %]", 8, Qt.AlignmentFlag.AlignRight)
    number.setId("Scale")
    _boxed(number, 225)
    number.setMarginX(2.0)
    _place(layout, number, bar.pos().x(), bottom - bar.rect().height() - 8, bar.rect().width(), 5.0)


def _add_north_arrow(layout, chart, frame):
    """In the upper right corner of the map, which is turned so that the road lies along the page."""
    arrow = QgsLayoutItemPicture(layout)
    arrow.setId("North")
    arrow.setPicturePath(NORTH_ARROW)
    arrow.setSvgFillColor(QColor(40, 40, 40))
    arrow.setSvgStrokeColor(QColor(40, 40, 40))
    _boxed(arrow, 200)
    arrow.setLinkedMap(chart)
    arrow.setNorthMode(QgsLayoutItemPicture.NorthMode.GridNorth)
    _place(layout, arrow, BORDER + frame.map_width - ARROW - 3, BORDER + HEADING + 3, ARROW, ARROW)


def _add_credit(layout, frame, credit):
    """In the lower left corner of the map."""
    label = _label(layout, as_it_stands(credit), 6.5)
    label.setVAlign(Qt.AlignmentFlag.AlignTop)
    label.setId("Credit")
    _boxed(label, 200)
    label.setMarginX(1.0)
    label.setMarginY(0.5)
    size, widest = label.sizeForText(), 0.5 * frame.map_width
    bottom = BORDER + HEADING + frame.map_height
    width, height = min(size.width() + 1.0, widest), size.height() * math.ceil(size.width() / (widest - 5.0)) + 0.5
    _place(layout, label, BORDER + 0.5, bottom - height - 0.5, width, height)


def _add_atlas(project, layout, chart, pages, crs, title):
    """One page of the atlas for each MapPage: its centre and its angle steer the map, the scale stays."""
    cover = QgsVectorLayer(f"Polygon?field=number:integer&field=angle:double&index=yes&crs={crs.authid()}",
                           tr("Pages of {title}").format(title=title), "memory")
    if not crs.authid():
        cover.setCrs(crs)
    features = []
    for number, page in enumerate(pages, 1):
        feature = QgsFeature(cover.fields())
        feature.setGeometry(page.outline)
        feature.setAttributes([number, -page.angle])
        features.append(feature)
    cover.dataProvider().addFeatures(features)
    cover.updateExtents()
    # It steers the pages; it is no part of the map, and not asked about when QGIS is closed
    cover.setCustomProperty("skipMemoryLayersCheck", 1)
    project.addMapLayer(cover, False)
    atlas = layout.atlas()
    atlas.setCoverageLayer(cover)
    atlas.setHideCoverage(True)
    atlas.setEnabled(True)
    atlas.setSortFeatures(True)
    atlas.setSortExpression("number")
    chart.setAtlasDriven(True)
    chart.setAtlasScalingMode(QgsLayoutItemMap.AtlasScalingMode.Fixed)
    chart.dataDefinedProperties().setProperty(QgsLayoutObject.DataDefinedProperty.MapRotation, QgsProperty.fromField("angle"))
    atlas.updateFeatures()
    atlas.beginRender()
    atlas.first()


# The legend of a print layout: the classes that a road map has, in as many columns as fit below the map.

TITLES, ENTRY = 12.0, 6.5        # mm: titles and margins of the legend, and each entry below a title
SIZES = ((8.0, 7.0, 4.0), (7.0, 6.0, 3.0), (6.0, 5.0, 2.0))  # letters of titles and entries, points, and symbols, mm: the first that fits
COLUMNS = 3                      # at least, where there are so many layers
FONT = "DejaVu Sans"
DPI = 300.0                      # of the measurement; any would do
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


def drawn(layers: list[QgsMapLayer]) -> list[QgsMapLayer]:
    """The layers of which a legend says something: lines, points and areas."""
    return [layer for layer in layers if layer.type() == Qgis.LayerType.Vector and layer.isSpatial()]


def classes_of(layer: QgsMapLayer) -> set[str]:
    """The keys of those classes of a layer's style that some feature has."""
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


def legend_height(layers: list[QgsMapLayer]) -> float:
    """mm that the longest layer takes in the legend, with the classes there are."""
    return TITLES + ENTRY * max([1, *(len(classes_of(layer)) for layer in drawn(layers))])


def add_legend(layout: QgsPrintLayout, layers: list[QgsMapLayer], room: QRectF) -> QgsLayoutItemLegend:
    """A legend in the upper left corner of `room` (mm).

    It lists the classes that there are. QGIS's own filter by the map is not used for that: it looks through the layers in the background and
    has timers, which may outlive the layers, and how large the legend becomes is not known before.
    """
    legend = QgsLayoutItemLegend(layout)
    layout.addLayoutItem(legend)
    legend.attemptMove(QgsLayoutPoint(room.x(), room.y(), Qgis.LayoutUnit.Millimeters))
    legend.setAutoUpdateModel(False)
    root = legend.model().rootGroup()
    root.clear()
    vectors = drawn(layers)
    for layer in vectors:
        node = root.addLayer(layer)
        _leave_out_empty_classes(legend, node, layer)
        _print_as_it_stands(legend, node, layer)
    legend.setSplitLayer(False)
    legend.setEqualColumnWidth(False)
    legend.setBackgroundColor(QColor(186, 191, 196))  # white paint is seen on it, and letters can be read
    legend.setColumnSpace(3)
    for sizes in SIZES:
        _set_sizes(legend, *sizes)
        for columns in range(min(COLUMNS, max(1, len(vectors))), max(1, len(vectors)) + 1):
            legend.setColumnCount(columns)
            size = _size(layout, legend)
            if size.height() <= room.height() and size.width() <= room.width():
                legend.attemptResize(QgsLayoutSize(size, Qgis.LayoutUnit.Millimeters))
                return legend
    return legend


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


def _leave_out_empty_classes(legend, node: QgsLayerTreeLayer, layer):
    classes = classes_of(layer)
    key = QgsLayerTreeModelLegendNode.LegendNodeRoles.RuleKeyRole
    order = [row for row, entry in enumerate(legend.model().layerOriginalLegendNodes(node)) if str(entry.data(key)) in classes]
    if order:
        QgsMapLayerLegendUtils.setLegendNodeOrder(node, order)
        legend.model().refreshLayerLegend(node)


def _print_as_it_stands(legend, node, layer):
    """Let no expression in the names of a layer and of its classes be evaluated."""
    if "[%" in layer.name():
        node.setCustomProperty("legend/title-label", as_it_stands(layer.name()))
    for row, entry in enumerate(legend.model().layerOriginalLegendNodes(node)):
        label = entry.symbolLabel() if isinstance(entry, QgsSymbolLegendNode) else ""
        if "[%" in label:
            QgsMapLayerLegendUtils.setLegendNodeUserLabel(node, row, as_it_stands(label))
            legend.model().refreshLayerLegend(node)


def _set_sizes(legend, title, entry, symbol):
    legend.setSymbolHeight(symbol)
    for style in STYLES:
        legend_style = legend.style(style)
        legend_style.setTextFormat(text_format(entry if style == QgsLegendStyle.Style.SymbolLabel else title))
        legend.setStyle(style, legend_style)


# Pages along a road that is too long for one: rectangles of one size, each turned so that the road runs along it.

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
