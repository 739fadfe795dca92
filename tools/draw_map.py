"""Draws the maps of the demo: draw_map.py PACKAGE IMAGE PICTURE [UAV_PACKAGE ORTHOIMAGE UAV_PICTURE].

The first has the road plan over the intensity image; the second the UAV image with the
driving lines by outcome and the residuals of its control points. Both have a title, a legend and a scale
bar, and every layer is drawn in the style it carries.
"""

import sys
from pathlib import Path

from plugin_package import load

# from above
LAYERS = (("driving_lines", "Driving lines"), ("road_edges", "Road edges"), ("marking_lines", "Marking lines"),
          ("markings", "Markings"), ("road_surface", "Road surface"))
UAV_LAYERS = (("residuals", "Residuals of the image"), ("driving_lines_by_outcome", "Driving lines, within 10 cm of the image's lanes"))
DPI, UAV_DPI = 150, 100  # a photograph takes room


def styled_layers(package, tables, image, title):
    """The layers of the package from above, in the styles they carry, and the image below them."""
    from qgis.core import QgsRasterLayer, QgsVectorLayer

    layers = []
    for table, name in tables:
        layer = QgsVectorLayer(f"{package}|layername={table}", name, "ogr")
        if not layer.isValid() or not layer.featureCount():
            sys.exit(f"Layer {table} of {package} is missing or empty.")
        if not layer.loadDefaultStyle()[1]:
            sys.exit(f"Layer {table} of {package} has no style of its own.")
        layers.append(layer)
    return [*layers, QgsRasterLayer(str(image), title)]


def clear_map(layout):
    """Move the scale bar from the map to the right of the legend."""
    from qgis.core import QgsLayoutItemMap, QgsLayoutItemScaleBar, QgsLayoutPoint

    paper = layout.pageCollection().page(0).pageSize()
    bottom = next(item.pos().y() + item.rect().height() for item in layout.items() if isinstance(item, QgsLayoutItemMap))
    for item in layout.items():
        if isinstance(item, QgsLayoutItemScaleBar):
            item.attemptMove(QgsLayoutPoint(paper.width() - item.rect().width() - 4, bottom + 4, paper.units()))


def draw(layers, picture, title, dpi=DPI, bare=False):
    """Lay the map out and save it; `bare` keeps the scale bar off the map."""
    from lanewright.desktop.layout.map_layout import road_map_layout
    from osgeo import gdal
    from qgis.core import QgsLayoutExporter, QgsProject
    from qgis.PyQt.QtCore import QCoreApplication

    project = QgsProject.instance()
    project.setCrs(layers[0].crs())
    for layer in layers:
        project.addMapLayer(layer)
    layout = road_map_layout(project, layers, title)
    if bare:
        clear_map(layout)
    QCoreApplication.processEvents()
    # QGIS tries to write the map's place into the picture, which a PNG cannot hold
    gdal.PushErrorHandler("CPLQuietErrorHandler")
    settings = QgsLayoutExporter.ImageExportSettings()
    settings.dpi = dpi
    settings.generateWorldFile = False
    result = QgsLayoutExporter(layout).exportToImage(str(picture), settings)
    gdal.PopErrorHandler()
    project.clear()
    if result != QgsLayoutExporter.ExportResult.Success:
        sys.exit(f"The map could not be written to {picture}.")


def fewer_colours(picture, colours=96):
    """Store a picture with a palette: a photograph as PNG is several times as large otherwise."""
    import cv2
    import numpy as np
    from osgeo import gdal

    pixels = cv2.imread(str(picture))
    # Noise of a few grey levels is what a PNG stores at such length
    calm = cv2.bilateralFilter(pixels, 5, 14, 3)
    sample = calm.reshape(-1, 3)[::7].astype(np.float32)
    cv2.setRNGSeed(1)
    _, _, centres = cv2.kmeans(sample, colours, None, (cv2.TERM_CRITERIA_MAX_ITER, 8, 1.0), 1, cv2.KMEANS_PP_CENTERS)
    nearest = cv2.flann_Index(centres, {"algorithm": 0}).knnSearch(calm.reshape(-1, 3).astype(np.float32), 1)[0]
    memory = gdal.GetDriverByName("MEM").Create("", pixels.shape[1], pixels.shape[0], 1)
    table = gdal.ColorTable()
    for number, (blue, green, red) in enumerate(np.rint(centres).astype(int).tolist()):
        table.SetColorEntry(number, (red, green, blue))
    memory.GetRasterBand(1).SetColorTable(table)
    memory.GetRasterBand(1).WriteArray(nearest.reshape(pixels.shape[:2]).astype(np.uint8))
    gdal.GetDriverByName("PNG").CreateCopy(str(picture), memory, options=["ZLEVEL=9"])


def main():
    package, image, picture, *uav = map(Path, sys.argv[1:7])
    from qgis.core import QgsApplication

    load()
    application = QgsApplication([], False)
    application.initQgis()
    try:
        draw(styled_layers(package, LAYERS, image, "Intensity image"), picture, "Lanewright: road map of the sample survey")
        if uav:
            package, image, picture = uav
            draw(styled_layers(package, UAV_LAYERS, image, "UAV image"), picture,
                 "Lanewright: driving lines over the georeferenced UAV image (simulated)", UAV_DPI, bare=True)
            fewer_colours(picture)
    finally:
        from qgis.core import QgsProject

        QgsProject.instance().clear()
        application.exitQgis()


if __name__ == "__main__":
    main()
