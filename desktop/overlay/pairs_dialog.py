"""A window that places UAV images by paint: images in, pairs of cut-outs to accept or refuse, georeferenced images out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsMapLayerProxyModel,
    QgsPointXY,
    QgsProcessingOutputLayerDefinition,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.gui import QgsMapCanvas, QgsMapLayerComboBox, QgsMapToolEmitPoint, QgsVertexMarker
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QIcon, QImage, QPainter, QPen, QPixmap
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QLabel,
    QListView,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QSplitter,
    QWidget,
)

from ...core.common.errors import RoadExtractionError
from ...core.io.geotiff import IntensityImage
from ...processing_provider.results.road_maps import runs_of
from ...processing_provider.texts import tr
from ...products.overlay.control_points import SourceImage, open_image
from ...products.overlay.matching.places import highest_order, left_out_residuals
from ...products.overlay.matching.propose import AMBIGUOUS, AWAY, REPEATS, WEAK
from ...products.overlay.rough_place import pair_cutouts
from ..background import BackgroundRun
from ..widgets import answers, button, column, row, show_extent, wrapped

IMAGES = "*.tif *.tiff *.jpg *.jpeg *.png *.TIF *.TIFF *.JPG *.JPEG *.PNG"
NEAR = 6.0      # m of ground about a pair that the map zooms to
_ID = Qt.ItemDataRole.UserRole


class PairsDialog(QDialog):
    """The window; `images` are its ImagePairs."""

    def __init__(self, iface):
        super().__init__(iface.mainWindow(), windowTitle=tr("Control points from paint"))
        self.setWindowFlag(Qt.WindowType.WindowMaximizeButtonHint)
        self.iface = iface
        self.images: list[ImagePairs] = []
        self._waiting: list = []
        self._run: BackgroundRun | None = None
        self._filling = False
        self.two_points: TwoPointsDialog | None = None
        self._build()
        self.resize(1160, 740)

    def _build(self):
        self.list = QListWidget(wordWrap=True, currentRowChanged=lambda row: self._show_pairs())
        self.intensity = QgsMapLayerComboBox()
        self.intensity.setFilters(QgsMapLayerProxyModel.Filter.RasterLayer)
        self._prefer_intensity()
        self.size = QDoubleSpinBox(decimals=3, minimum=0.0, maximum=1.0, singleStep=0.005, suffix=" m", specialValueText=tr("as the image says"))
        self.rough_button = button(tr("Two points by hand…"), self.point, tr(
            "Where the chosen image says nothing of its position: two places clicked in it and in the intensity image"))
        self.propose_button = button(tr("Propose control points"), self.propose)
        form = QFormLayout(rowWrapPolicy=QFormLayout.RowWrapPolicy.WrapAllRows)
        form.addRow(tr("Intensity image"), self.intensity)
        form.addRow(tr("Pixel size of the image on the ground"), self.size)
        files = row(button(tr("Add images…"), self.ask_for_images), button(tr("Remove"), self._remove))
        left = column(QWidget(), QLabel(tr("Images")), (self.list, 1), files, form, row(self.rough_button, self.propose_button), rim=0)
        self.pairs = QListWidget(
            viewMode=QListView.ViewMode.IconMode, resizeMode=QListView.ResizeMode.Adjust, movement=QListView.Movement.Static, spacing=6,
            selectionMode=QAbstractItemView.SelectionMode.ExtendedSelection, iconSize=QSize(2 * SIDE + GAP, SIDE), itemChanged=self._ticked,
            itemDoubleClicked=self._zoom)
        self.message = wrapped(tr("Add images, choose the intensity image, and let control points be proposed."))
        accept, refuse = (button(text, lambda accepted=accepted: self.accept_selected(accepted)) for text, accepted in (
            (tr("Accept the selected"), True), (tr("Refuse the selected"), False)))
        self.place_button = button(tr("Georeference the images"), self.place)
        self.bar = QProgressBar(visible=False)
        seen = QLabel(tr("Left the image, right the intensity image. A tick accepts a pair, a double click shows it on the map."))
        right = column(QWidget(), seen, (self.pairs, 1), self.message, self.bar, row(accept, refuse, None, self.place_button), rim=0)
        parts = QSplitter()
        parts.addWidget(left)
        parts.addWidget(right)
        parts.setSizes([270, 890])
        column(self, parts)
        self.intensity.layerChanged.connect(lambda layer: self._show_pairs())  # the list of pairs is there now
        self._enable()

    def _prefer_intensity(self):
        """Choose the intensity image of the last road map, where there is one."""
        images = (run.layer("INTENSITY_IMAGE") for run in runs_of(QgsProject.instance()))
        called = (layer for layer in QgsProject.instance().mapLayers().values() if "intensity" in Path(layer.source()).stem.lower())
        likely = next((layer for layer in (*images, *called) if layer is not None), None)
        if likely is not None:
            self.intensity.setLayer(likely)

    # -- images -----------------------------------------------------------------------------------

    def ask_for_images(self) -> None:
        self.add(QFileDialog.getOpenFileNames(self, tr("Images of a flight"), "", f"{tr('Images')} ({IMAGES});;{tr('All files')} (*.*)")[0])

    def add(self, paths: list[str]) -> None:
        listed = {image.path for image in self.images}
        for path in paths:
            if path not in listed:
                self.images.append(ImagePairs(path))
                self.list.addItem("")
        self._tell()
        if self.list.currentRow() < 0 and self.images:
            self.list.setCurrentRow(0)

    def _remove(self):
        number = self.list.currentRow()
        if number >= 0 and self._run is None:
            del self.images[number]
            self.list.takeItem(number)
            self._tell()

    @property
    def current(self) -> ImagePairs | None:
        """The image whose pairs are shown."""
        number = self.list.currentRow()
        return self.images[number] if 0 <= number < len(self.images) else None

    def _tell(self):
        """The state of every image in the list, that of the current one below its pairs."""
        for number, image in enumerate(self.images):
            self.list.item(number).setText(f"{image.name}\n{image.summary()}")
        if self.current is not None:
            self.message.setText(f"{self.current.name}: {self.current.summary()}")
        self._enable()

    def _enable(self):
        idle = self._run is None
        self.propose_button.setEnabled(idle and bool(self.images) and self.intensity.currentLayer() is not None)
        self.rough_button.setEnabled(idle and self.current is not None and self.intensity.currentLayer() is not None)
        self.place_button.setEnabled(idle and any(image.order for image in self.images))
        self.bar.setVisible(not idle)

    # -- pairs ------------------------------------------------------------------------------------

    def _show_pairs(self):
        self._filling = True
        self.pairs.clear()
        image, intensity = self.current, self.intensity.currentLayer()
        if image is not None and intensity is not None and image.layer is not None:
            try:
                pictures = image.pictures(intensity.source())
            except RoadExtractionError as problem:
                pictures = []
                self.message.setText(str(problem))
            for pair, picture in zip(image.rows(), pictures):
                item = QListWidgetItem(QIcon(picture), "")
                item.setData(_ID, pair.id())
                item.setFlags(item.flags() | Qt.ItemFlag.ItemIsUserCheckable)
                self.pairs.addItem(item)
        self._filling = False
        self._label()

    def _label(self):
        """Text, tick and colour of every pair, from the layer."""
        self._filling = True
        rows = {pair.id(): pair for pair in self.current.rows()} if self.current is not None else {}
        for number in range(self.pairs.count()):
            item = self.pairs.item(number)
            pair = rows.get(item.data(_ID))
            if pair is not None:
                item.setText(pair_text(pair))
                item.setCheckState(Qt.CheckState.Checked if pair["accepted"] else Qt.CheckState.Unchecked)
                item.setForeground(QBrush(QColor(GREEN if pair["accepted"] else RED)))
        self._filling = False
        self._tell()

    def _ticked(self, item):
        if not self._filling and self.current is not None:
            self.current.accept([item.data(_ID)], item.checkState() == Qt.CheckState.Checked)
            self._label()

    def accept_selected(self, accepted: bool) -> None:
        ids = [item.data(_ID) for item in self.pairs.selectedItems()]
        if ids and self.current is not None:
            self.current.accept(ids, accepted)
            self._label()

    def _zoom(self, item):
        layer = self.current.layer if self.current is not None else None
        if layer is None:
            return
        point: QgsPointXY = layer.getFeature(item.data(_ID)).geometry().asPoint()
        show_extent(self.iface.mapCanvas(), QgsRectangle.fromCenterAndSize(point, 2 * NEAR, 2 * NEAR), layer.crs())

    # -- runs -------------------------------------------------------------------------------------

    def propose(self) -> None:
        """Look for pairs in every image that has none yet, one image after the other."""
        inputs = {"INTENSITY_IMAGE": self.intensity.currentLayer().id(), "PIXEL_SIZE": self.size.value()}
        output = {"CONTROL_POINTS": QgsProcessingOutputLayerDefinition("TEMPORARY_OUTPUT", QgsProject.instance())}
        self._waiting = [("proposecontrolpoints", image, {"IMAGE": image.path, "ROUGH_POINTS": image.rough, **inputs, **output})
                         for image in self.images if image.layer is None]
        self._next()

    def point(self) -> None:
        """Ask for two points of the chosen image."""
        try:
            self.two_points = TwoPointsDialog(self.current.path, self.intensity.currentLayer(), self)
        except RoadExtractionError as problem:
            self.message.setText(str(problem))
            return
        image, dialog = self.current, self.two_points
        dialog.finished.connect(lambda result: self._pointed(image, dialog, result))
        dialog.open()

    def _pointed(self, one, dialog, result):
        if result == QDialog.DialogCode.Accepted:
            one.forget(dialog.layer)
            self._show_pairs()
        self.two_points = None
        dialog.deleteLater()

    def place(self) -> None:
        """Georeference every image that has enough accepted pairs, and put it into the project."""
        self._waiting = [("georeferenceimage", image, {
            "IMAGE": image.path, "GCPS": image.layer.id(), "ORDER": image.order,
            "OUTPUT": QgsProcessingOutputLayerDefinition(_free_name(image.path), QgsProject.instance())}) for image in self.images if image.order]
        self._next()

    def _next(self):
        if not self._waiting:
            self._run = None
            self._show_pairs()
            return
        name, image, inputs = self._waiting.pop(0)
        self._run = BackgroundRun(name, inputs, lambda run, fine: self._ended(image, run, fine))
        self._run.feedback.progressChanged.connect(lambda share: self.bar.setValue(int(share)))
        self.bar.setValue(0)
        self.message.setText(f"{image.name}: {self._run.algorithm.declaration.title()}…")
        self._enable()

    def _ended(self, one, run, fine):
        try:
            if fine:
                run.load_results()
                layer = QgsProject.instance().mapLayer(run.results.get("CONTROL_POINTS", ""))
                if layer is not None:
                    one.found(layer)
                else:
                    one.placed = tr("On the map: {file}").format(file=Path(str(run.results.get("OUTPUT", ""))).name)
            elif "CONTROL_POINTS" in run.parameters:
                one.forget(why=run.reason)
            else:
                one.placed = run.reason
        finally:  # or the window would wait for ever
            self._next()


def _free_name(path):
    """A GeoTIFF beside the image that is not there yet."""
    image = Path(path)
    names = (image.with_name(f"{image.stem}_map{number}.tif") for number in ("", *range(2, 1000)))
    return str(next(name for name in names if not name.exists()))


# Two points pointed at in an image and in the intensity image: where the image lies, roughly.

COLOURS = ("#ff00c8", "#00c8ff")  # of the first and the second point
NEEDED = len(COLOURS)


class TwoPointsDialog(QDialog):
    """The image beside the intensity image; `layer` has the points once there are two in each."""

    def __init__(self, path: str, intensity: QgsRasterLayer, parent: QWidget | None = None):
        super().__init__(parent, windowTitle=tr("Two points in both images"))
        self.image: SourceImage = open_image(path)
        self.intensity = intensity
        self.photo = QgsRasterLayer(path, "image")
        self.message = wrapped()
        self.places: dict[QgsMapCanvas, list[QgsPointXY]] = {}
        self.marks: list[tuple[QgsMapCanvas, QgsVertexMarker]] = []
        self.tools = []  # a canvas keeps no reference
        self.views = [self._canvas(layer) for layer in (self.photo, intensity)]
        self.buttons = answers(self, button(tr("Begin again"), self.begin))
        column(self, self.message, (row(*self.views), 1), self.buttons)
        self.resize(1100, 620)
        self.begin()

    def _canvas(self, layer):
        view = QgsMapCanvas(self)
        view.setCanvasColor(QColor("#1c1c1e"))
        view.setDestinationCrs(layer.crs() if layer is self.intensity else QgsCoordinateReferenceSystem())
        view.setLayers([layer])
        view.setExtent(layer.extent())
        self.tools.append(QgsMapToolEmitPoint(view, canvasClicked=lambda point, button: self.point_at(view, point)))
        view.setMapTool(self.tools[-1])
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
        self.message.setText(tr("Good: the places may be off by some metres.") if ready else tr(
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


# One image of the window of control points: its layer of pairs, what the accepted ones say, and their pictures.

SIDE = 116       # px, of a cut-out
GAP = 4          # px, between the two of a pair
CROSS = 7        # px, half the cross in the middle
GREEN, RED = "#33a02c", "#e6323c"
# Why a pair is not accepted by default, in the user's language
REASONS = {WEAK: tr("looks different"), REPEATS: tr("repeats nearby"), AWAY: tr("does not fit the others"),
           AMBIGUOUS: tr("all of it fits elsewhere too")}


class ImagePairs:
    """An image and its pairs.

    path : of the image
    failed : why no pairs were found, "" where none were looked for or some were found
    rough : layer of two points that say roughly where it lies, None where none were given
    placed : what became of placing it on the map, "" before
    """

    def __init__(self, path: str):
        self.path = path
        self.failed = self.placed = ""
        self.rough: QgsVectorLayer | None = None
        self._layer = ""

    @property
    def name(self) -> str:
        return Path(self.path).name

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer of pairs; None where there is none, or it was taken out of the project."""
        return QgsProject.instance().mapLayer(self._layer)

    def found(self, layer: QgsVectorLayer) -> None:
        """Take the layer that "Propose control points" made."""
        self._layer, self.failed, self.placed = layer.id(), "", ""
        layer.setName(tr("Control points of {image}").format(image=Path(self.path).stem))

    def forget(self, rough: QgsVectorLayer | None = None, why: str = "") -> None:
        """Forget the pairs: two rough points were given, or there is a reason why none were found."""
        self.rough, self._layer, self.failed = self.rough if rough is None else rough, "", why

    def rows(self) -> list:
        """The features of the layer, in order of their names."""
        layer = self.layer
        return [] if layer is None else sorted(layer.getFeatures(), key=lambda row: int(row["point"]))

    def accept(self, ids: list[int], accepted: bool) -> None:
        layer = self.layer
        if layer is None:
            return
        column = layer.fields().lookupField("accepted")
        layer.dataProvider().changeAttributeValues({number: {column: int(accepted)} for number in ids})
        self._write_residuals(layer)
        layer.triggerRepaint()

    def _write_residuals(self, layer):
        """How far off the accepted pairs place each one, anew."""
        rows = self.rows()
        pixel, line, x, y = _places(rows)
        x, y = x - x.mean(), y - y.mean()
        used = np.array([bool(row["accepted"]) for row in rows])
        order = highest_order(x[used], y[used]) if used.any() else 0
        residual = left_out_residuals(x, y, pixel, line, used, order) if order else np.full(len(rows), np.nan)
        column = layer.fields().lookupField("residual")
        layer.dataProvider().changeAttributeValues(
            {row.id(): {column: float(value) if value == value else NULL} for row, value in zip(rows, residual)})

    @property
    def order(self) -> int:
        """Of the polynomial that the accepted pairs determine; 0: none."""
        accepted = [row for row in self.rows() if row["accepted"]]
        return highest_order(*_places(accepted)[2:]) if accepted else 0

    def summary(self) -> str:
        """What is known of the image, for the list of images."""
        if self.failed:
            return self.failed
        rows = self.rows()
        if not rows:
            return tr("not looked for yet") if self.rough is None else tr("two points given, not looked for yet")
        residuals = [row["residual"] for row in rows if row["accepted"] and row["residual"] not in (None, NULL)]
        summary = tr("{accepted} of {count} pairs accepted").format(accepted=sum(bool(row["accepted"]) for row in rows), count=len(rows))
        if residuals:
            summary += tr(", RMSE {rmse:.1f} cm, each left out in turn").format(rmse=100.0 * float(np.sqrt(np.mean(np.square(residuals)))))
        return f"{summary}\n{self.placed}" if self.placed else summary

    def pictures(self, intensity_path: str) -> list[QPixmap]:
        """Both cut-outs of each pair side by side, in the order of the rows."""
        rows = self.rows()
        if len(rows) < 2:
            return []
        images = open_image(self.path), IntensityImage.open(intensity_path)
        return [_side_by_side(*pair) for pair in pair_cutouts(*images, *_places(rows), side=SIDE)]


def _places(rows):
    """(4, N) pixel, line, easting and northing of pairs."""
    return np.array([(row["pixel"], row["line"], row.geometry().constGet().x(), row.geometry().constGet().y()) for row in rows], float).T


def pair_text(row) -> str:
    """Number, likeness and residual of a pair."""
    residual = row["residual"]
    distance = tr("{residual:.1f} cm off").format(residual=100.0 * residual) if residual not in (None, NULL) else "–"
    why = "" if row["accepted"] or row["why"] in (None, NULL, "") else f"\n{REASONS.get(row['why'], row['why'])}"
    return tr("{number}: likeness {score:.2f}, {away}").format(number=row["point"], score=row["score"], away=distance) + why


def _side_by_side(*cuts):
    canvas = QPixmap(2 * SIDE + GAP, SIDE)
    canvas.fill(Qt.GlobalColor.white)
    painter = QPainter(canvas)
    for number, cut in enumerate(cuts):
        left = number * (SIDE + GAP)
        data = np.ascontiguousarray(cut)
        painter.drawImage(left, 0, QImage(data.data, SIDE, SIDE, 3 * SIDE, QImage.Format.Format_RGB888).copy())
        painter.setPen(QPen(Qt.GlobalColor.yellow, 1))
        middle = left + SIDE // 2
        painter.drawLine(middle - CROSS, SIDE // 2, middle + CROSS, SIDE // 2)
        painter.drawLine(middle, SIDE // 2 - CROSS, middle, SIDE // 2 + CROSS)
    painter.end()
    return canvas
