"""A print layout of a road map: A4 or A3, a round scale, legend, scale bar and north arrow; an atlas where the road is long."""

from __future__ import annotations

import math
from dataclasses import dataclass

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeature,
    QgsGeometry,
    QgsLayoutItemLabel,
    QgsLayoutItemMap,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsLayoutObject,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsMapLayer,
    QgsPrintLayout,
    QgsProject,
    QgsProperty,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QRectF, Qt
from qgis.PyQt.QtGui import QColor

from ...processing_provider.texts import tr
from .layout_legend import add_legend, as_it_stands, legend_height, text_format
from .page_series import MapPage, pages_along

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


def lie_of_the_road(layers: list[QgsMapLayer], crs: QgsCoordinateReferenceSystem | None = None,
                    project: QgsProject | None = None) -> tuple:
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
