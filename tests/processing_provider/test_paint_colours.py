"""Colours of paint, as QGIS runs it: from an orthoimage to what the road plan draws."""

import pytest
from osgeo import gdal
from qgis.core import QgsMapRendererParallelJob, QgsMapSettings, QgsProcessingException, QgsVectorLayer
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor

YELLOW, WHITE, ASPHALT = (214, 172, 72), (235, 235, 228), (96, 96, 94)


@pytest.fixture(scope="module")
def orthoimage(street_map, tmp_path_factory):
    """An image of 2 cm pixels over the markings of the street: paint left of the middle is yellow, the rest is white."""
    markings = QgsVectorLayer(street_map["MARKINGS"], "markings", "ogr")
    box, path = markings.extent().buffered(2.0), str(tmp_path_factory.mktemp("image") / "ortho.tif")
    image = gdal.GetDriverByName("GTiff").Create(path, int(box.width() / 0.02), int(box.height() / 0.02), 3)
    image.SetGeoTransform((box.xMinimum(), 0.02, 0, box.yMaximum(), 0, -0.02))
    image.SetProjection(markings.crs().toWkt())
    for band, value in enumerate(ASPHALT, 1):
        image.GetRasterBand(band).Fill(value)
    source = gdal.OpenEx(street_map["MARKINGS"])
    layer = source.GetLayer(0)
    for where, colour in (("offset_m <= 0", WHITE), ("offset_m > 0", YELLOW)):
        layer.SetAttributeFilter(where)
        gdal.RasterizeLayer(image, [1, 2, 3], layer, burn_values=list(colour))
    return path


def test_an_orthoimage_colours_the_paint_and_the_road_plan_draws_it(street_map, orthoimage, tmp_path, project):
    import processing

    made = processing.run("lanewright:paintcolours", {"MARKINGS": street_map["MARKINGS"], "IMAGE": orthoimage,
                                                      "COLOURED_MARKINGS": str(tmp_path / "coloured.gpkg")})
    layer = QgsVectorLayer(made["COLOURED_MARKINGS"], "coloured", "ogr")
    rows = [(feature["offset_m"], feature["colour"], feature.geometry()) for feature in layer.getFeatures()]
    assert len(rows) == QgsVectorLayer(street_map["MARKINGS"], "markings", "ogr").featureCount() == made["WHITE"] + made["YELLOW"]
    assert {colour for _, colour, _ in rows} == {"white", "yellow"}
    assert all(colour == ("yellow" if offset > 0 else "white") for offset, colour, _ in rows)
    for wanted, looks in (("yellow", lambda red, blue: red > 180 and blue < 80), ("white", lambda red, blue: red > 240 and blue > 240)):
        shape = max((shape for _, colour, shape in rows if colour == wanted), key=lambda shape: shape.area())
        red, blue = middle_of(drawn(layer, shape.boundingBox().buffered(0.5)), shape)
        assert looks(red, blue), (wanted, red, blue)


def drawn(layer, box):
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setDestinationCrs(layer.crs())
    settings.setBackgroundColor(QColor("#606060"))
    settings.setOutputSize(QSize(400, 400))
    settings.setExtent(box)
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage(), settings.mapToPixel()


def middle_of(picture, shape):
    image, place = picture
    at = place.transform(shape.pointOnSurface().asPoint())
    colour = image.pixelColor(int(at.x()), int(at.y()))
    return colour.red(), colour.blue()


@pytest.mark.parametrize("given, says", [({}, "Nothing shows the colours"), ({"IMAGE": "intensity"}, "fewer than three bands")])
def test_without_colours_there_is_one_sentence_and_no_layer(street_map, tmp_path, given, says):
    import processing

    images = {name: street_map["INTENSITY_IMAGE"] for name in given}
    with pytest.raises(QgsProcessingException, match=says):
        processing.run("lanewright:paintcolours", {"MARKINGS": street_map["MARKINGS"], **images, "COLOURED_MARKINGS": str(tmp_path / "out.gpkg")})
    assert not list(tmp_path.iterdir())
