"""A window that places UAV images by paint: images in, pairs of cut-outs to accept or refuse, georeferenced images out."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsMapLayerProxyModel, QgsPointXY, QgsProcessingOutputLayerDefinition, QgsProject, QgsRectangle
from qgis.gui import QgsMapLayerComboBox
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QIcon
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDoubleSpinBox,
    QFileDialog,
    QFormLayout,
    QLabel,
    QListView,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QSplitter,
    QVBoxLayout,
    QWidget,
)

from ...core.common.errors import RoadExtractionError
from ...processing_provider.results.road_maps import runs_of
from ...processing_provider.texts import tr
from ..background import BackgroundRun
from ..widgets import button, row, show_extent, wrapped
from .image_pairs import GAP, GREEN, RED, SIDE, ImagePairs, pair_text
from .two_points_dialog import TwoPointsDialog

IMAGES = "*.tif *.tiff *.jpg *.jpeg *.png *.TIF *.TIFF *.JPG *.JPEG *.PNG"
NEAR = 6.0      # m of ground about a pair that the map zooms to
_ID = Qt.ItemDataRole.UserRole


class PairsDialog(QDialog):
    """The window; `images` are its ImagePairs."""

    def __init__(self, iface):
        super().__init__(iface.mainWindow())
        self.setWindowTitle(tr("Control points from paint"))
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
        self.list = QListWidget()
        self.list.setWordWrap(True)
        self.list.currentRowChanged.connect(lambda row: self._show_pairs())
        self.intensity = QgsMapLayerComboBox()
        self.intensity.setFilters(QgsMapLayerProxyModel.Filter.RasterLayer)
        self._prefer_intensity()
        self.size = QDoubleSpinBox()
        self.size.setRange(0.0, 1.0)
        self.size.setDecimals(3)
        self.size.setSingleStep(0.005)
        self.size.setSuffix(" m")
        self.size.setSpecialValueText(tr("as the image says"))
        self.rough_button = button(tr("Two points by hand…"), self.point, tr(
            "Where the chosen image says nothing of its position: two places clicked in it and in the intensity image"))
        self.propose_button = button(tr("Propose control points"), self.propose)
        form = QFormLayout()
        form.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapAllRows)
        form.addRow(tr("Intensity image"), self.intensity)
        form.addRow(tr("Pixel size of the image on the ground"), self.size)
        left = QWidget()
        column = QVBoxLayout(left)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(QLabel(tr("Images")))
        column.addWidget(self.list, 1)
        column.addLayout(row(button(tr("Add images…"), lambda: self.add(self.ask_for_images())), button(tr("Remove"), self._remove)))
        column.addLayout(form)
        column.addLayout(row(self.rough_button, self.propose_button))
        self.pairs = QListWidget()
        self.pairs.setViewMode(QListView.ViewMode.IconMode)
        self.pairs.setResizeMode(QListView.ResizeMode.Adjust)
        self.pairs.setMovement(QListView.Movement.Static)
        self.pairs.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.pairs.setIconSize(QSize(2 * SIDE + GAP, SIDE))
        self.pairs.setSpacing(6)
        self.pairs.itemChanged.connect(self._ticked)
        self.pairs.itemDoubleClicked.connect(self._zoom)
        self.told = wrapped(tr("Add images, choose the intensity image, and let control points be proposed."))
        accept, refuse = (button(text, lambda accepted=accepted: self.accept_selected(accepted)) for text, accepted in (
            (tr("Accept the selected"), True), (tr("Refuse the selected"), False)))
        self.place_button = button(tr("Georeference the images"), self.place)
        self.bar = QProgressBar()
        self.bar.hide()
        right = QWidget()
        column = QVBoxLayout(right)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(QLabel(tr("Left the image, right the intensity image. A tick accepts a pair, a double click shows it on the map.")))
        column.addWidget(self.pairs, 1)
        column.addWidget(self.told)
        column.addWidget(self.bar)
        column.addLayout(row(accept, refuse, None, self.place_button))
        parts = QSplitter()
        parts.addWidget(left)
        parts.addWidget(right)
        parts.setSizes([270, 890])
        QVBoxLayout(self).addWidget(parts)
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

    def ask_for_images(self) -> list[str]:
        """The files that the user chooses."""
        return QFileDialog.getOpenFileNames(self, tr("Images of a flight"), "", f"{tr('Images')} ({IMAGES});;{tr('All files')} (*.*)")[0]

    def add(self, paths: list[str]) -> None:
        """Add images to the list."""
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
            self.told.setText(f"{self.current.name}: {self.current.summary()}")
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
                self.told.setText(str(problem))
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
        """Accept or refuse the pairs that are selected."""
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
            self.told.setText(str(problem))
            return
        image, dialog = self.current, self.two_points
        dialog.finished.connect(lambda result: self._pointed(image, dialog, result))
        dialog.open()

    def _pointed(self, one, dialog, result):
        if result == QDialog.DialogCode.Accepted:
            one.lies_about(dialog.layer)
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
        self.told.setText(f"{image.name}: {self._run.algorithm.declaration.title()}…")
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
                one.failed_because(run.reason)
            else:
                one.placed = run.reason
        finally:  # or the window would wait for ever
            self._next()


def _free_name(path):
    """A GeoTIFF beside the image that is not there yet."""
    image = Path(path)
    names = (image.with_name(f"{image.stem}_map{number}.tif") for number in ("", *range(2, 1000)))
    return str(next(name for name in names if not name.exists()))
