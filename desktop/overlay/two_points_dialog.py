"""Two points pointed at in an image and in the intensity image: where the image lies, roughly."""

from __future__ import annotations

from qgis.core import QgsCoordinateReferenceSystem, QgsFeature, QgsGeometry, QgsPointXY, QgsRasterLayer, QgsVectorLayer
from qgis.gui import QgsMapCanvas, QgsMapToolEmitPoint, QgsVertexMarker
from qgis.PyQt.QtGui import QColor
from qgis.PyQt.QtWidgets import QDialog, QDialogButtonBox, QVBoxLayout, QWidget

from ...processing_provider.texts import tr
from ...products.overlay.source_image import SourceImage, open_image
from ..widgets import answers, button, row, wrapped

COLOURS = ("#ff00c8", "#00c8ff")  # of the first and the second point
NEEDED = len(COLOURS)


class TwoPointsDialog(QDialog):
    """The image beside the intensity image; `layer` has the points once there are two in each."""

    def __init__(self, path: str, intensity: QgsRasterLayer, parent: QWidget | None = None):
        super().__init__(parent)
        self.setWindowTitle(tr("Two points in both images"))
        self.image: SourceImage = open_image(path)
        self.intensity = intensity
        self.photo = QgsRasterLayer(path, "image")
        self.told = wrapped()
        self.places: dict[QgsMapCanvas, list[QgsPointXY]] = {}
        self.marks: list[tuple[QgsMapCanvas, QgsVertexMarker]] = []
        self.tools = []  # a canvas keeps no reference
        self.views = [self._canvas(layer) for layer in (self.photo, intensity)]
        self.buttons = answers(self, button(tr("Begin again"), self.begin))
        column = QVBoxLayout(self)
        column.addWidget(self.told)
        column.addLayout(row(*self.views), 1)
        column.addWidget(self.buttons)
        self.resize(1100, 620)
        self.begin()

    def _canvas(self, layer):
        view = QgsMapCanvas(self)
        view.setCanvasColor(QColor("#1c1c1e"))
        view.setDestinationCrs(layer.crs() if layer is self.intensity else QgsCoordinateReferenceSystem())
        view.setLayers([layer])
        view.setExtent(layer.extent())
        tool = QgsMapToolEmitPoint(view)
        tool.canvasClicked.connect(lambda point, button, view=view: self.point_at(view, point))
        view.setMapTool(tool)
        self.tools.append(tool)
        return view

    def done(self, result: int) -> None:
        """Close; the views stop drawing layers that may be gone before they are."""
        for view, tool in zip(self.views, self.tools):
            view.stopRendering()
            view.unsetMapTool(tool)
            view.setLayers([])
        super().done(result)

    def begin(self) -> None:
        """Forget the points."""
        for view, mark in self.marks:
            view.scene().removeItem(mark)
        self.marks = []
        self.places = {view: [] for view in self.views}
        self._tell()

    def point_at(self, view: QgsMapCanvas, point: QgsPointXY) -> None:
        """Take a point that was clicked in one of the views."""
        places = self.places[view]
        if len(places) == NEEDED:
            return
        mark = QgsVertexMarker(view)
        mark.setCenter(point)
        mark.setColor(QColor(COLOURS[len(places)]))
        mark.setIconType(QgsVertexMarker.IconType.ICON_CROSS)
        mark.setIconSize(16)
        mark.setPenWidth(3)
        self.marks.append((view, mark))
        places.append(point)
        self._tell()

    def _tell(self):
        in_image, in_intensity = (len(self.places[view]) for view in self.views)
        ready = in_image == in_intensity == NEEDED
        self.buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(ready)
        self.told.setText(tr("Good: the places may be off by some metres.") if ready else tr(
            "Click two places far apart in the image on the left, and the same two in the same order in the intensity image on the right. The wheel "
            "comes nearer. In the image: {seen}, in the intensity image: {known}.").format(seen=in_image, known=in_intensity))

    @property
    def layer(self) -> QgsVectorLayer | None:
        """A point layer with the fields pixel and line; None where points are missing."""
        if any(len(places) < NEEDED for places in self.places.values()):
            return None
        points = QgsVectorLayer("Point?field=pixel:double&field=line:double", "rough points", "memory")
        points.setCrs(self.intensity.crs())
        features = []
        for image_point, map_point in zip(*(self.places[view] for view in self.views)):
            feature = QgsFeature(points.fields())
            feature.setGeometry(QgsGeometry.fromPointXY(map_point))
            feature.setAttributes(list(self._pixel(image_point)))
            features.append(feature)
        points.dataProvider().addFeatures(features)
        points.updateExtents()
        return points

    def _pixel(self, place):
        """Pixel and line of a place as QGIS shows the image."""
        if self.image.geotransform is not None:
            return tuple(float(value) for value in self.image.pixel_of(place.x(), place.y()))
        extent = self.photo.extent()
        return ((place.x() - extent.xMinimum()) / extent.width() * self.image.width,
                (extent.yMaximum() - place.y()) / extent.height() * self.image.height)
