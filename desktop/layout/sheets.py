"""Sheets along a road as one print layout: overview, plan sheets with match lines and title block, longitudinal profile, cross-sections."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import date

import numpy as np
import shapely
from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsLayoutExporter,
    QgsLayoutItemLabel,
    QgsLayoutItemMap,
    QgsLayoutItemPage,
    QgsLayoutItemPicture,
    QgsLayoutItemScaleBar,
    QgsLayoutPoint,
    QgsLayoutSize,
    QgsMapLayer,
    QgsMapRendererCustomPainterJob,
    QgsPointXY,
    QgsPrintLayout,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingUtils,
    QgsProject,
    QgsRectangle,
    QgsUnitTypes,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QLocale, QMarginsF, QRectF, QSizeF, Qt
from qgis.PyQt.QtGui import QColor, QImage, QPageLayout, QPageSize, QPainter, QPdfWriter

from ...algorithms.algorithm import MAP_LAYERS
from ...algorithms.export import DRAWN, SheetSettings
from ...algorithms.provenance import own_version
from ...algorithms.survey_input import survey_name
from ...core.common.arrays import round_step
from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.common.texts import language
from ...core.survey.las.reader import read_blocks, read_headers
from ...processing_provider.results.road_maps import CLOUDS, origin_of, road_map_of
from ...processing_provider.styling import LOOKS, STYLES, apply_style
from ...processing_provider.texts import speak, tr
from .axes import MapLine, Sheet, accuracy_of, axes_of, lines_of, road_lines, sheets_along
from .drawing import (
    COLOURS,
    DARK,
    GREY,
    LETTER,
    Drawing,
    add_legend,
    as_it_stands,
    classes_by_layer,
    legend_height,
    profile_pages,
    section_pages,
    station_text,
    text_format,
    text_width,
)

PAPERS = {"A4": (297.0, 210.0), "A3": (420.0, 297.0), "A2": (594.0, 420.0), "A1": (841.0, 594.0), "A0": (1189.0, 841.0)}  # mm, ISO 216
SCALES = (100, 200, 250, 500, 1000, 2000, 2500, 5000, 10_000, 20_000, 25_000, 50_000, 100_000)
BY_ITSELF = (100, 200, 250, 500, 1000, 2000, 5000)   # the scales that are chosen where none is given, SINGLE for one sheet alone
SINGLE = (100, 200)
MOST_BY_ITSELF = 20   # sheets at such a scale
MOST_SHEETS = 500     # more would take hours to draw
RIM, RING = 8.0, 5.0  # mm: from the paper's edge to the frame, and from there to the map, where coordinates stand
BAND = {"A4": 46.0}   # mm of the strip below the map; of larger paper LARGER_BAND
LARGER_BAND = 60.0
TITLE_BLOCK = 180.0   # mm at most (ISO 7200), TITLE_SHARE of the width on small paper
TITLE_SHARE = 0.55
MOST_LEGEND = 0.4     # of the overview's height
AROUND = 2.0          # m of ground around the road
ARROW = 14.0          # mm
NOTES = 9.0           # mm for the notes below profiles and sections
ABOVE = 18.0          # mm above the title block for scale and arrow, where the legend takes their place
GRID = 60.0           # mm between lines of the grid at least
TICKS, LABELS = 5.0, 25.0   # mm between ticks and labels of stations at least
MATCH = 50.0          # mm beside the road to which a match line reaches, with its text
AXIS = "#b00020"
LAID_OUT = 4.0         # pixels a mm at which labels are laid out to see which find room
ROWS = (0.28, 0.18, 0.18, 0.18, 0.18)   # of the title block's height
NORTH_ARROW = ":/images/north_arrows/layout_default_north_arrow.svg"  # of QGIS itself


@dataclass(frozen=True)
class Frame:
    """The page and the rectangles on it, mm."""

    width: float
    height: float
    band: float

    @property
    def map(self) -> QRectF:
        edge = RIM + RING
        return QRectF(edge, edge, self.width - 2 * edge, self.height - 2 * edge - self.band)

    @property
    def strip(self) -> QRectF:
        return QRectF(RIM, self.height - RIM - self.band, self.width - 2 * RIM, self.band)

    def title_block(self, band: float) -> QRectF:
        width = min(TITLE_BLOCK, TITLE_SHARE * self.strip.width())
        return QRectF(self.strip.right() - width, self.strip.bottom() - band, width, band)


def frame_of(choice: SheetSettings) -> Frame:
    long, short = PAPERS[choice.paper]
    return Frame(*((short, long) if choice.orientation == "portrait" else (long, short)), BAND.get(choice.paper, LARGER_BAND))


def map_crs(layers: list[QgsMapLayer], project: QgsProject) -> QgsCoordinateReferenceSystem:
    """The CRS that the map is drawn in: that of the first layer with a projected one, whatever the project shows."""
    all_crs = [layer.crs() for layer in layers if layer.isSpatial() and layer.crs().isValid()]
    return next((crs for crs in all_crs if not crs.isGeographic()), all_crs[0] if all_crs else project.crs())


def sheet_layout(project: QgsProject, layers: dict[str, QgsMapLayer], choice: SheetSettings, below: QgsMapLayer | None = None,
                 ground: Iterable[np.ndarray] = (), progress: Progress = Progress()) -> tuple[QgsPrintLayout, dict[str, float]]:
    """All pages in one layout, which is not yet added to the project's layouts; and SHEETS, PAGES and SCALE_NUMBER.

    project : QgsProject that will own the layout
    layers : result (such as ROAD_EDGES) -> its layer, from above
    below : layer drawn below these and left out of the legend: an orthoimage, a web map
    ground : blocks of (N, 3) points of the road, metres, which the cross-sections show

    Raises RoadExtractionError where no line runs along a road, or it would take too many sheets.
    """
    made = _Pages(project, layers, choice, below, ground, progress)
    return made.layout, {"SHEETS": float(len(made.sheets)), "PAGES": float(made.pages), "SCALE_NUMBER": float(made.scale)}


class _Pages:
    def __init__(self, project, layers, choice, below, ground, progress):
        self.progress = progress
        self.choice, self.layers = choice, list(layers.values())
        self.classes = classes_by_layer(self.layers)
        self.drawn = [*self.layers, *([below] if below is not None else [])]
        self.crs = map_crs(self.layers, project)
        self.unit = QgsUnitTypes.fromUnitToUnitFactor(self.crs.mapUnits(), Qgis.DistanceUnit.Meters)   # m
        self.lines: list[MapLine] = lines_of(layers, self.crs, project, self.unit)
        self.axes = axes_of(road_lines(self.lines))
        if not self.axes:
            raise RoadExtractionError(tr("No line of the layers runs along a road for 5 m, so sheets have no direction. Give driving lines, road "
                                         "edges or marking lines of a road map."))
        self.frame = frame_of(choice)
        self.scale, self.sheets = self._sheets()
        self.accuracy = accuracy_of(layers)
        self.layout = QgsPrintLayout(project)
        self.layout.initializeDefaults()
        self.layout.setName(choice.title)
        self.pages = 0
        self._add_pages(ground)

    def _sheets(self):
        """(scale, sheets) as chosen; by itself the largest scale that shows the road's width, on no more than MOST_BY_ITSELF sheets."""
        chosen = 0 if self.choice.scale == "automatic" else int(self.choice.scale.partition(":")[2])
        for scale in (chosen,) if chosen else BY_ITSELF:
            width, height = self.frame.map.width() / 1000 * scale, self.frame.map.height() / 1000 * scale
            expected = sum(axis.length for axis in self.axes) / width
            if expected > MOST_SHEETS:
                continue
            if not chosen and scale != BY_ITSELF[-1] and (
                    expected > (1 if scale in SINGLE else MOST_BY_ITSELF) or 2 * (self.axes[0].half_width + AROUND) > height):
                continue
            sheets = sheets_along(self.axes, width, height)
            if chosen or len(sheets) <= (1 if scale in SINGLE else MOST_BY_ITSELF) or scale == BY_ITSELF[-1]:
                return scale, sheets
        raise RoadExtractionError(tr("The road would take more than {count} sheets. Choose a smaller scale or larger paper.").format(
            count=MOST_SHEETS))

    # -- pages ------------------------------------------------------------------------------

    def _add_pages(self, ground):
        room = self._legend_room(self.frame)
        probe = add_legend(self.layout, self.classes, room)
        self.legend_on_sheets = probe is not None
        if probe is not None:
            self.layout.removeLayoutItem(probe)
        if len(self.sheets) > 1 or not self.legend_on_sheets:
            self._add_overview()
        for sheet in self.sheets:
            self._add_sheet(sheet)
        heights = (tr("Heights in m: height system as stated"), "")
        size, interval = (self.frame.map.width(), self.frame.map.height() - NOTES), self.choice.section_interval
        self._report()
        profiles = profile_pages(self.axes, *size, self.scale, len(self.sheets)) if self.choice.profile else []
        self._report()
        sections = section_pages(self.axes, self.lines, ground, interval, *size) if interval else []
        drawn = [(profile, tr("Longitudinal profile"), [(tr("Ground along the axis"), AXIS), heights]) for profile in profiles]
        drawn += [(section, tr("Cross-sections"), [
            (tr("Road edge, height of its curb"), COLOURS["ROAD_EDGES"]), (tr("Marking line"), COLOURS["MARKING_LINES"]),
            (tr("Driving line"), COLOURS["DRIVING_LINES"]), (tr("Ground"), DARK), (tr("Offsets in m from the axis, left positive"), ""), heights])
            for section in sections]
        pages: list = []
        for one in drawn:   # below the one before, where there is room
            if not pages or sum(part[0][0].height for part in (*pages[-1], one)) > size[1] + 1e-6:
                pages.append([])
            pages[-1].append(one)
        for number, parts in enumerate(pages, 1):
            page, paper, y = self._new_page(), self._paper(self.frame), self.frame.map.y()
            self._add_title_block(paper, page, self.frame, ", ".join(contents for _, contents, _ in parts), f"{number} / {len(pages)}",
                                  "; ".join(scale for (_, scale), _, _ in parts))
            self._add_key_map(paper, page, None)
            self._add_notes(paper, dict.fromkeys(note for _, _, notes in parts for note in notes))
            self._add_drawing(paper, page)
            for (drawing, _), _, _ in parts:
                self._add_drawing(drawing, page, self.frame.map.x(), y)
                y += drawing.height

    def _report(self):
        """How far the work is; between two reports QGIS lets the window live."""
        self.progress.report(self.pages / (self.pages + len(self.sheets)))

    def _new_page(self):
        self._report()
        if self.pages:
            self.layout.pageCollection().addPage(QgsLayoutItemPage(self.layout))
        self.layout.pageCollection().page(self.pages).setPageSize(
            QgsLayoutSize(self.frame.width, self.frame.height, Qgis.LayoutUnit.Millimeters))
        self.pages += 1
        return self.pages - 1

    def _add_overview(self):
        """The whole road with the sheets on it, and the legend."""
        page, base = self._new_page(), self.frame.band
        tall, aside = min(legend_height(self.classes), MOST_LEGEND * self.frame.height), True
        for band, aside in ((base, True), (max(base, tall), True), (max(base + ABOVE, tall), False), (base + tall, True)):
            frame = Frame(self.frame.width, self.frame.height, band)
            room = self._legend_room(frame, base)
            if not aside:   # scale and arrow stand above the title block
                room.setRight(frame.title_block(base).left() - 1)
            if band == base + tall:   # all of it stands there
                room = QRectF(room.x(), room.y(), frame.strip.width() - 2, tall - 2)
            if add_legend(self.layout, self.classes, room, page) is not None:
                break
        outlines = shapely.union_all([sheet.outline() for sheet in self.sheets])
        box = outlines.minimum_rotated_rectangle
        corners = np.array(box.exterior.coords[:4]) if box.geom_type == "Polygon" else np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        sides = np.diff(corners[:3], axis=0)
        along = sides[np.argmax(np.hypot(*sides.T))]
        heading = math.atan2(along[1], along[0])
        if frame.map.width() < frame.map.height():
            heading += math.pi / 2
        heading = (heading + math.pi / 2) % math.pi - math.pi / 2   # north in the upper half
        centre = box.centroid
        view = Sheet(0, centre.x, centre.y, heading, 1.0, 1.0)
        spread = np.abs(view.on_page(shapely.get_coordinates(outlines)) - 0.5).max(0) * 2 + 2 * AROUND
        needed = max(spread[0] / frame.map.width(), spread[1] / frame.map.height()) * 1000
        scale = next((scale for scale in SCALES if scale >= needed), int(needed) + 1)
        view = Sheet(0, centre.x, centre.y, heading, frame.map.width() / 1000 * scale, frame.map.height() / 1000 * scale)
        chart = self._add_map(view, page, frame, scale)
        paper = self._paper(frame)
        over = Drawing(frame.map.width(), frame.map.height())
        if len(self.sheets) > 1:
            self._draw_sheets(over, view, scale, None, 11.0)
        self._add_title_block(paper, page, frame, tr("Overview"), f"1 – {len(self.sheets)}" if len(self.sheets) > 1 else "1", f"1 : {scale}", base)
        self._add_scale_and_north(chart, page, frame, scale, base, aside)
        self._draw_grid(paper, view, frame, scale)
        self._add_drawing(over, page, frame.map.x(), frame.map.y())
        self._add_drawing(paper, page)

    def _add_sheet(self, sheet):
        page, frame = self._new_page(), self.frame
        chart = self._add_map(sheet, page, frame, self.scale)
        paper = self._paper(frame)
        over = Drawing(frame.map.width(), frame.map.height())
        self._draw_matches(over, sheet)
        self._draw_stations(over, sheet)
        self._draw_grid(paper, sheet, frame, self.scale)
        self._add_title_block(paper, page, frame, tr("Road plan"), tr("{number} of {count}").format(number=sheet.number, count=len(self.sheets)),
                              f"1 : {self.scale}")
        self._add_key_map(paper, page, sheet)
        if self.legend_on_sheets:
            add_legend(self.layout, self.classes, self._legend_room(frame), page)
        self._add_scale_and_north(chart, page, frame, self.scale, frame.band)
        self._explain(paper, chart)
        self._add_drawing(over, page, frame.map.x(), frame.map.y())
        self._add_drawing(paper, page)

    def _legend_room(self, frame, base=None):
        """Between the key map, where there is one, and the scale."""
        strip, block = frame.strip, frame.title_block(frame.band)
        left = strip.x() + 1 + (self._key_width() if base is None and len(self.sheets) > 1 else 0.0)
        return QRectF(left, strip.y() + 1, block.left() - 45 - left, strip.height() - 2)

    def _key_width(self):
        return min(1.3 * self.frame.band, self.frame.title_block(self.frame.band).left() - 45 - RIM)

    # -- what stands on a page --------------------------------------------------------------

    def _paper(self, frame):
        """A drawing over the whole page, with its frame."""
        paper = Drawing(frame.width, frame.height)
        edge = QRectF(RIM, RIM, frame.width - 2 * RIM, frame.height - 2 * RIM)
        for rectangle, width in ((edge, 0.5), (frame.map, 0.25)):
            paper.line(_corners(rectangle), width=width, closed=True)
        paper.line([(frame.strip.left(), frame.strip.top()), (frame.strip.right(), frame.strip.top())], width=0.5)
        return paper

    def _place(self, item, page, x, y, width=0.0, height=0.0):
        self.layout.addLayoutItem(item)
        if width:
            item.attemptResize(QgsLayoutSize(width, height, Qgis.LayoutUnit.Millimeters))
        item.attemptMove(QgsLayoutPoint(x, y, Qgis.LayoutUnit.Millimeters), page=page)

    def _add_drawing(self, drawing, page, x=0.0, y=0.0):
        picture = QgsLayoutItemPicture(self.layout)
        picture.setPicturePath(drawing.path())
        self._place(picture, page, x, y, drawing.width, drawing.height)

    def _add_map(self, sheet, page, frame, scale):
        chart = QgsLayoutItemMap(self.layout)
        chart.setId("Map" if not page else f"Map {page + 1}")
        self._place(chart, page, frame.map.x(), frame.map.y(), frame.map.width(), frame.map.height())
        chart.setCrs(self.crs)
        chart.setLayers(self.drawn)
        chart.setKeepLayerSet(True)
        chart.zoomToExtent(QgsRectangle.fromCenterAndSize(QgsPointXY(sheet.x / self.unit, sheet.y / self.unit), sheet.width / self.unit,
                                                          sheet.height / self.unit))
        chart.setScale(scale)
        chart.setMapRotation(math.degrees(sheet.heading))
        chart.setBackgroundColor(QColor(255, 255, 255))
        if self.choice.credit:
            self._add_credit(page, frame)
        return chart

    def _add_credit(self, page, frame):
        """In the lower left corner of the map."""
        label = self._label(self.choice.credit, 6.0)
        label.setId("Credit")
        label.setBackgroundEnabled(True)
        label.setBackgroundColor(QColor(255, 255, 255, 200))
        label.setMarginX(1.0)
        wide, widest = text_width(self.choice.credit, 6.0) + 4.0, 0.5 * frame.map.width()
        height = 3.2 * math.ceil(wide / (widest - 5.0)) + 0.8
        self._place(label, page, frame.map.x() + 0.5, frame.map.bottom() - height - 0.5, min(wide, widest), height)

    def _label(self, text, size):
        label = QgsLayoutItemLabel(self.layout)
        label.setText(as_it_stands(text))
        label.setTextFormat(text_format(size))
        label.setVAlign(Qt.AlignmentFlag.AlignVCenter)
        label.setMarginX(0.0)
        label.setMarginY(0.0)
        return label

    def _add_scale_and_north(self, chart, page, frame, scale, band, aside=True):
        """Beside the title block, else above it, where they cover no road; the arrow is turned with the map."""
        block = frame.title_block(band)
        x, top = (block.left() - 44, block.top()) if aside else (block.left() + 15, frame.strip.top())
        arrow = QgsLayoutItemPicture(self.layout)
        arrow.setId("North")
        arrow.setPicturePath(NORTH_ARROW)
        arrow.setSvgFillColor(QColor(40, 40, 40))
        arrow.setSvgStrokeColor(QColor(40, 40, 40))
        self._place(arrow, page, x + 21 - ARROW / 2, top + 1 if aside else top + 2, ARROW, ARROW)
        arrow.setLinkedMap(chart)
        arrow.setNorthMode(QgsLayoutItemPicture.NorthMode.GridNorth)
        bar = QgsLayoutItemScaleBar(self.layout)
        bar.setStyle("Single Box")
        bar.setLinkedMap(chart)
        bar.setUnits(Qgis.DistanceUnit.Meters)
        bar.setUnitLabel("m")
        segment = round_step(0.0065 * scale)
        bar.setNumberOfSegments(int(0.034 * scale / segment))
        bar.setNumberOfSegmentsLeft(0)
        bar.setUnitsPerSegment(segment)
        bar.setTextFormat(text_format(7))
        bar.setHeight(1.8)
        bar.update()
        width, height = bar.rect().width(), bar.rect().height()
        self._place(bar, page, *((x + 21 - width / 2, top + band - height - 3) if aside else (x + 45, top + 4)))

    def _explain(self, paper, chart):
        """What the red line and those figures say that found room on the map, between arrow and scale."""
        x, y = self.frame.title_block(self.frame.band).left() - 40, self.frame.strip.top() + ARROW + 3.5
        paper.line([(x, y), (x + 8, y)], AXIS, 0.25, "5 1 0.6 1")
        settings = chart.mapSettings(chart.extent(), QSizeF(chart.rect().width(), chart.rect().height()) * LAID_OUT, 25.4 * LAID_OUT, True)
        settings.setLayers([layer for layer in self.layers if isinstance(layer, QgsVectorLayer)])
        settings.setFlag(Qgis.MapSettingsFlag.SkipSymbolRendering)
        image = QImage(1, 1, QImage.Format.Format_RGB32)
        painter = QPainter(image)
        job = QgsMapRendererCustomPainterJob(settings, painter)
        job.renderSynchronously()
        painter.end()
        figures = " · ".join(label.labelText for label in job.takeLabelingResults().allLabels() if not label.isUnplaced)
        rows = [("", tr("Axis with stations"))] + [(figure, text) for figure, text, pattern in (
            ("R 85", tr("Radius (m)"), r"R \d"), ("3.40", tr("Width of the lane (m)"), r"(^|· )\d+[.,]\d\d( ·|$)"),
            ("50 km/h", tr("Design speed"), r"\d km/h"), ("12 cm", tr("Height of the curb"), r"\d cm")) if re.search(pattern, figures)]
        for row, (figure, text) in enumerate(rows):
            paper.text(x, y + 2.6 * row, figure, 5.5, "start")
            paper.text(x + 10, y + 2.6 * row, text, 5.5, "start")

    def _add_title_block(self, paper, page, frame, contents, number, scale, band=None):
        """Who made what, when, where and how well; captions are drawn, what was chosen stands in labels that can be changed."""
        self._report()
        block, choice = frame.title_block(band or frame.band), self.choice
        heights = choice.heights or (self.crs.verticalCrs().userFriendlyIdentifier() if self.crs.verticalCrs().isValid()
                                     else tr("as in the point clouds"))
        rows = ([(tr("Project"), choice.title, 0.76, 12.0), (tr("Sheet"), number, 0.24, 12.0)],
                [(tr("Office"), choice.office, 0.42, 8.0), (tr("Author"), choice.author, 0.34, 8.0), (tr("Date"), str(date.today()), 0.24, 8.0)],
                [(tr("Contents"), contents, 0.42, 8.0), (tr("Scale"), scale, 0.34, 8.0), (tr("Paper"), choice.paper, 0.24, 8.0)],
                [(tr("CRS"), self.crs.userFriendlyIdentifier(), 0.6, 8.0), (tr("Height system"), heights, 0.4, 8.0)],
                [(tr("Accuracy, one sigma across"), self.accuracy, 0.76, 7.0), (tr("Software"), f"Lanewright {own_version()}", 0.24, 7.0)])
        paper.line(_corners(block), width=0.5, closed=True)
        y = block.top()
        for share, row in zip(ROWS, rows):
            height, x = share * block.height(), block.left()
            paper.line([(block.left(), y), (block.right(), y)])
            for caption, text, part, size in row:
                width = part * block.width()
                if x > block.left():
                    paper.line([(x, y), (x, y + height)])
                paper.text(x + 1, y + 1.7, caption, 5.0, "start", colour=GREY)
                while size > 5.0 and text_width(text, size) > 0.9 * (width - 2) * max(int((height - 2.8) / (1.3 * LETTER * size)), 1):
                    size -= 0.5
                self._place(self._label(text, size), page, x + 1, y + 2.6, width - 2, height - 2.8)
                x += width
            y += height

    # -- what is drawn over the map ---------------------------------------------------------

    def _draw_sheets(self, drawing, view, scale, current, size=7.0):
        """Outlines of the sheets with their numbers; the current one filled."""
        per_mm = scale / 1000
        for sheet in self.sheets:
            corners = view.on_page(np.array(sheet.outline().exterior.coords[:4])) / per_mm
            chosen = current is not None and sheet.number == current.number
            drawing.line(corners, AXIS if chosen else DARK, 0.4 if chosen else 0.2, fill="#b0002030" if chosen else "none", closed=True)
        for sheet in sorted(self.sheets, key=lambda one: current is not None and one.number != current.number):
            x, y = view.on_page(np.array([[sheet.x, sheet.y]]))[0] / per_mm
            drawing.text(x, y, str(sheet.number), size, boxed=True, yields=True)

    def _add_notes(self, paper, notes):
        """What the colours of a page mean, along the lower side of the frame."""
        box, x, row = self.frame.map, self.frame.map.x() + 3, 0
        for text, colour in notes:
            width = text_width(text, 6.0) + (9 if colour else 0) + 6
            if x + width > box.right():
                x, row = box.x() + 3, row + 1
            y = box.bottom() - NOTES + 2.5 + 4 * row
            if colour:
                paper.line([(x, y), (x + 7, y)], colour, 0.8)
            paper.text(x + (9 if colour else 0), y, text, 6.0, "start")
            x += width

    def _add_key_map(self, paper, page, current):
        """All sheets over the road, north up, where there are several."""
        if len(self.sheets) < 2:
            return
        strip = self.frame.strip
        drawing = Drawing(self._key_width(), self.frame.band)
        bounds = np.array(shapely.union_all([sheet.outline() for sheet in self.sheets]).bounds)
        scale = 1000 * max((bounds[2] - bounds[0]) / (drawing.width - 3), (bounds[3] - bounds[1]) / (drawing.height - 8))
        middle = (bounds[:2] + bounds[2:]) / 2
        view = Sheet(0, middle[0], middle[1] + 0.0025 * scale, 0.0, drawing.width / 1000 * scale, drawing.height / 1000 * scale)
        for axis in self.axes:
            drawing.line(view.on_page(axis.places) / scale * 1000, GREY, 0.5)
        self._draw_sheets(drawing, view, scale, current)
        drawing.text(1, 2.2, tr("Key map, north up"), 5.0, "start", colour=GREY)
        self._add_drawing(drawing, page, strip.x(), strip.y())
        paper.line([(strip.x() + drawing.width, strip.top()), (strip.x() + drawing.width, strip.bottom())])

    def _draw_matches(self, drawing, sheet):
        per_mm = self.scale / 1000
        for match in sheet.matches:
            across = np.array([-math.sin(match.heading), math.cos(match.heading)])
            axis = min(self.axes, key=lambda one: np.hypot(*(one.places[:, :2] - (match.x, match.y)).T).min())
            reach = axis.half_width + MATCH * per_mm
            ends = sheet.on_page(np.array([match.x, match.y]) + np.outer([-reach, reach], across)) / per_mm
            line = shapely.clip_by_rect(shapely.LineString(ends), 0, 0, drawing.width, drawing.height)
            if line.is_empty:
                continue
            places = shapely.get_coordinates(line)
            drawing.line(places, width=0.4, dash="6 1.5 1 1.5")
            top, bottom = places[np.argsort(places[:, 1])]
            way = (bottom - top) / max(np.hypot(*(bottom - top)), 1e-9)
            outwards = np.sign((sheet.on_page(np.array([[match.x, match.y]]))[0] / per_mm - (drawing.width / 2, drawing.height / 2))[0]) or 1.0
            turned = math.degrees(math.atan2(way[1], way[0])) - 90
            turned = turned - 90 if abs(turned) < 60 else turned + 90
            text = tr("Match line, sheet {number}").format(number=match.neighbour)
            room = (text_width(text, 8.0) / 2 + 3) * way
            for place in (top + room, bottom - room):
                drawing.text(*(place + 2.2 * outwards * np.array([way[1], -way[0]])), text, 8.0, turned=turned, boxed=True, yields=True)

    def _draw_stations(self, drawing, sheet):
        """The axis with a tick every 10 m (more at small scales) and stations beside the road."""
        per_mm = self.scale / 1000
        ticks = next(step for step in (10, 20, 50, 100, 200, 500, 1000) if step >= TICKS * per_mm)
        labels = next(ticks * times for times in (1, 5, 10, 50) if ticks * times >= LABELS * per_mm)
        for axis in self.axes:
            course = shapely.clip_by_rect(shapely.LineString(sheet.on_page(axis.places) / per_mm), 0, 0, drawing.width, drawing.height)
            for part in shapely.get_parts(course):
                drawing.line(shapely.get_coordinates(part), AXIS, 0.15, "5 1 0.6 1")
            for station in np.arange(math.ceil(axis.stations[0] / ticks) * ticks, axis.stations[-1] + 1e-6, ticks):
                self._draw_station(drawing, sheet, axis, float(station), abs(station / labels - round(station / labels)) < 1e-6)

    def _draw_station(self, drawing, sheet, axis, station, labelled):
        per_mm, heading = self.scale / 1000, axis.heading(station)
        left = np.array([-math.sin(heading), math.cos(heading)])
        place = axis.at(np.array([station]))[0, :2]
        x, y = sheet.on_page(place[None])[0] / per_mm
        if not (0 < x < drawing.width and 0 < y < drawing.height):
            return
        reach = (1.6 if labelled else 0.8) * per_mm
        drawing.line(sheet.on_page(place + np.outer([-reach, reach], left)) / per_mm, AXIS, 0.25)
        if not labelled:
            return
        text = station_text(station)
        for side in (-1, 1):
            outside = axis.half_width + 1.5 * per_mm
            leader = sheet.on_page(place + np.outer([side * outside, side * (outside + 2.5 * per_mm)], left)) / per_mm
            way = leader[1] - leader[0]
            turned = math.degrees(math.atan2(way[1], way[0]))
            upright = (turned + 135) % 180 - 135   # read from below or from the right
            middle = leader[1] + way / max(np.hypot(*way), 1e-9) * (text_width(text, 7.0) / 2 + 1)
            if drawing.text(*middle, text, 7.0, turned=upright, colour=AXIS, boxed=True, yields=True):
                drawing.line(leader, AXIS, 0.25)
                return

    def _draw_grid(self, paper, sheet, frame, scale):
        """Crosses where lines of the grid meet, and their coordinates along the map's frame."""
        step, per_mm = round_step(GRID * scale / 1000 / self.unit), scale / 1000
        corners = np.array(sheet.outline().exterior.coords[:4]) / self.unit
        easts, norths = (np.arange(math.ceil(low / step), math.floor(high / step) + 1) * step
                         for low, high in zip(corners.min(0), corners.max(0)))
        place = lambda points: sheet.on_page(np.asarray(points, float) * self.unit) / per_mm + (frame.map.x(), frame.map.y())  # noqa: E731
        arm = 2.0 * per_mm / self.unit
        for east in easts:
            for north in norths:
                x, y = place([[east, north]])[0]
                if frame.map.contains(x, y):
                    for dx, dy in ((arm, 0), (0, arm)):
                        paper.line(place([[east - dx, north - dy], [east + dx, north + dy]]), GREY, 0.15)
        upright = abs(math.cos(sheet.heading)) >= abs(math.sin(sheet.heading))   # lines of equal east are the steeper ones on the page
        sides, low, high = np.array(sheet.outline().exterior.coords), corners.min(0) * self.unit, corners.max(0) * self.unit
        for values, axis, word in ((easts, 0, tr("E")), (norths, 1, tr("N"))):
            level = (axis == 0) == upright   # they meet the upper and lower frame
            rim = shapely.multilinestrings([sides[k:k + 2] for k in ((0, 2) if level else (1, 3))])
            for value in values:
                line = np.array([low, high])
                line[:, axis] = value * self.unit
                for x, y in place(shapely.get_coordinates(rim.intersection(shapely.linestrings(line))) / self.unit):
                    out = np.array([0, math.copysign(1, y - frame.map.center().y())] if level else [math.copysign(1, x - frame.map.center().x()), 0])
                    paper.line([(x, y), (x, y) + out * 1.2], width=0.25)
                    paper.text(*((x, y) + out * 2.9), f"{word} {value:.0f}", 5.5, turned=0 if level else -90, yields=True)


def _corners(box: QRectF) -> list[tuple[float, float]]:
    return [(box.left(), box.top()), (box.right(), box.top()), (box.right(), box.bottom()), (box.left(), box.bottom())]


# One run of Sheets along the road: its layers, the layout, and the PDF.

PDF_END = b"%%EOF"   # the last line of a whole PDF
DPI, DPI_OF_LARGE = 300, {"A1": 200, "A0": 150}   # of images on a sheet: an A0 of 300 dpi takes more than half a gigabyte


def print_sheets(call, settings: SheetSettings, progress: Progress) -> dict[str, float]:
    """Draw the sheets of a QgisCall into its OUTPUT; returns the numbers of the algorithm."""
    spoken, chosen, signs = language(), call.value("LANGUAGE"), QLocale()
    try:
        if chosen != "automatic":
            speak(chosen)
            QLocale.setDefault(QLocale(chosen))   # of the numbers in labels
        return _print(call, settings, progress)
    finally:
        speak(spoken)
        QLocale.setDefault(signs)


def _print(call, settings, progress):
    project = call.context.project() or QgsProject()
    call.at_end(lambda: project)   # a project of our own lives as long as its layout
    layers = {name: layer for name in DRAWN if (layer := _layer(call, name, project)) is not None}
    if not layers:
        raise RoadExtractionError(tr("No layer was given. Choose the layers of a road map that the sheets are to show."))
    cloud = call.cloud("ROAD_POINTS")
    layout, numbers = sheet_layout(project, layers, _completed(settings, layers, project), _layer(call, "BELOW", project),
                                   _ground(cloud, progress.part(0.1, 0.3)) if cloud else (), progress.part(0.0, 0.1))
    write_pdf(layout, call.new_file("OUTPUT"), progress.part(0.3 if cloud else 0.1, 1.0), DPI_OF_LARGE.get(settings.paper, DPI))
    progress.info(tr("{sheets} plan sheets of 1 : {scale}, {pages} pages in all.").format(
        sheets=int(numbers["SHEETS"]), scale=int(numbers["SCALE_NUMBER"]), pages=int(numbers["PAGES"])))
    if call.value("KEEP") and call.context.project() is not None:
        if all(project.mapLayer(layer.id()) is not None for layer in layers.values()):
            layout.setName(unused_name(project, layout.name()))
            project.layoutManager().addLayout(layout)
        else:
            progress.info(tr("The layout was not kept in the project, which lacks its layers: add the files to the project and choose them there."))
    return numbers


def _layer(call, name, project) -> QgsMapLayer | None:
    """A layer as the project shows it; one that comes from a file as this program shows it."""
    value = call.parameters.get(name)
    if isinstance(value, QgsProcessingFeatureSourceDefinition):
        value = value.source.staticValue()
    if value in (None, ""):
        return None
    layer = value if isinstance(value, QgsMapLayer) else QgsProcessingUtils.mapLayerFromString(str(value), call.context)
    if layer is None:
        raise RoadExtractionError(tr("{label}: {value} cannot be opened as a layer. Check the name and the folder.").format(
            label=call.label(name), value=value))
    if project.mapLayer(layer.id()) is None and name in LOOKS:
        apply_style(layer, STYLES / f"{LOOKS[name][0]}.qml", (), name)
        layer.setName(tr(MAP_LAYERS[name].label))
    return layer


def _completed(settings, layers, project):
    """The settings with the name of the survey where no title was chosen."""
    if settings.title.strip():
        return settings
    road_map = next((one for layer in layers.values() if (one := road_map_of(layer, project)) is not None), None)
    if road_map is not None:
        return replace(settings, title=road_map.title)
    clouds = next((origin.provenance.values.get(CLOUDS) for layer in layers.values() if (origin := origin_of(layer)) is not None), None)
    named = clouds if isinstance(clouds, list) else [clouds or next(iter(layers.values())).source().split("|")[0]]
    return replace(settings, title=survey_name([str(name) for name in named]) or tr("Road map"))


def _ground(path, progress) -> Iterator[np.ndarray]:
    """(N, 3) points of a cloud in metres, block by block."""
    file, = read_headers([path], progress.warn)
    read = 0
    for block in read_blocks(file.path, layers=("z",), units=file.units):
        read += len(block)
        progress.report(read / max(file.count, 1))
        yield np.c_[np.asarray(block.x), np.asarray(block.y), np.asarray(block.z)]


def write_pdf(layout: QgsPrintLayout, path: str, progress: Progress, dpi: int = DPI) -> None:
    """Write all pages, each of its own size; between two pages the user may cancel. Raises RoadExtractionError where the file cannot be written."""
    layout.renderContext().setDpi(dpi)
    layout.renderContext().setTextRenderFormat(Qgis.TextRenderFormat.AlwaysText)
    exporter, pages = QgsLayoutExporter(layout), layout.pageCollection()
    writer = QPdfWriter(path)
    writer.setResolution(dpi)
    writer.setTitle(layout.name())
    writer.setCreator("Lanewright")
    painter, failed = None, tr("The PDF {path} cannot be written. Choose another place, or free some space there.").format(path=path)
    try:
        for number in range(pages.pageCount()):
            progress.report(number / pages.pageCount())
            size = pages.page(number).pageSize().toQSizeF()
            writer.setPageLayout(QPageLayout(QPageSize(size, QPageSize.Unit.Millimeter), QPageLayout.Orientation.Portrait, QMarginsF(0, 0, 0, 0)))
            if painter is None:
                painter = QPainter(writer)
            if not painter.isActive() or number and not writer.newPage():
                raise RoadExtractionError(failed)
            exporter.renderPage(painter, number)
    finally:
        if painter is not None:
            painter.end()
    # Qt does not say where the disk was full
    with open(path, "rb") as file:
        file.seek(max(file.seek(0, os.SEEK_END) - 2 * len(PDF_END), 0))
        if PDF_END not in file.read():
            raise RoadExtractionError(failed)


def unused_name(project: QgsProject, name: str) -> str:
    """The name, numbered where the project has a layout of that name."""
    used = {layout.name() for layout in project.layoutManager().printLayouts()}
    names = (name if number == 1 else f"{name} {number}" for number in range(1, len(used) + 2))
    return next(free for free in names if free not in used)
