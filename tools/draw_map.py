"""Draws the maps of the demo: draw_map.py PACKAGE IMAGE PICTURE [UAV_PACKAGE ORTHOIMAGE UAV_PICTURE].

The first has the road plan over the intensity image; the second the UAV image with the
driving lines by outcome and the residuals of its control points. Both are sheets with title block, legend and scale
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


def draw(layers, picture, title, dpi=DPI):
    """Lay the map out as one plan sheet, and save it; layers by the result that they are, and below them an image."""
    from lanewright.algorithms.export import SheetSettings
    from lanewright.desktop.layout.sheets import sheet_layout
    from qgis.core import QgsLayoutExporter, QgsProject
    from qgis.PyQt.QtCore import QCoreApplication

    *drawn, image = layers
    project = QgsProject.instance()
    project.setCrs(image.crs())
    for layer in layers:
        project.addMapLayer(layer)
    layout, _ = sheet_layout(project, {layer.source().partition("layername=")[2].upper(): layer for layer in drawn},
                             SheetSettings(title, paper="A4", scale="1:500", profile=False, section_interval=0.0), image)
    QCoreApplication.processEvents()
    if not QgsLayoutExporter(layout).renderPageToImage(layout.pageCollection().pageCount() - 1, dpi=dpi).save(str(picture)):
        sys.exit(f"The map could not be written to {picture}.")
    project.clear()


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
                 "Lanewright: driving lines over the georeferenced UAV image (simulated)", UAV_DPI)
            fewer_colours(picture)
    finally:
        from qgis.core import QgsProject

        QgsProject.instance().clear()
        application.exitQgis()


if __name__ == "__main__":
    main()
