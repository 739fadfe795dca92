"""One run of Sheets along the road: its layers, the layout, and the PDF."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from qgis.core import (
    Qgis,
    QgsLayoutExporter,
    QgsMapLayer,
    QgsPrintLayout,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingUtils,
    QgsProject,
)
from qgis.PyQt.QtCore import QMarginsF
from qgis.PyQt.QtGui import QPageLayout, QPageSize, QPainter, QPdfWriter

from ...algorithms.export import DRAWN, SheetSettings
from ...algorithms.map_layers import MAP_LAYERS
from ...algorithms.survey_files import survey_name
from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.common.texts import language
from ...core.survey.las.reader import read_blocks, read_headers
from ...processing_provider.results.road_maps import CLOUDS, origin_of, road_map_of
from ...processing_provider.styling import LOOKS, STYLES, apply_style
from ...processing_provider.texts import speak, tr
from .sheets import sheet_layout

PDF_END = b"%%EOF"   # the last line of a whole PDF
DPI, DPI_OF_LARGE = 300, {"A1": 200, "A0": 150}   # of images on a sheet: an A0 of 300 dpi takes more than half a gigabyte


def print_sheets(call, settings: SheetSettings, progress: Progress) -> dict[str, float]:
    """Draw the sheets of a QgisCall into its OUTPUT; returns the numbers of the algorithm."""
    spoken, chosen = language(), call.value("LANGUAGE")
    try:
        if chosen != "automatic":
            speak(chosen)
        return _print(call, settings, progress)
    finally:
        speak(spoken)


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
    """Write all pages, each of its own size; between two pages the user may cancel.

    Raises RoadExtractionError where the file cannot be written.
    """
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
