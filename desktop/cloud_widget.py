"""The point clouds of a survey in dialogs: files, folders, wildcards and layers of the project, typed, chosen or dropped."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsMimeDataUtils, QgsProject, QgsSettings
from qgis.gui import QgsProcessingGui
from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtGui import QDragEnterEvent, QDropEvent
from qgis.PyQt.QtWidgets import QFileDialog, QHBoxLayout, QLineEdit, QMenu, QToolButton, QWidget

from ..algorithms.survey_files import SUFFIXES, VIRTUAL, cloud_files
from ..core.common.errors import RoadExtractionError
from ..processing_provider.algorithm import CLOUD_FILTER
from ..processing_provider.texts import tr
from .dialog_wrapper import DialogWrapper
from .widgets import LAST_INPUT, column, wrapped

SEPARATOR = ";"
MEGABYTE = 1e6
MOST_HEADERS = 200          # files whose headers are read for the line below the names
GPS_EPOCH, ADJUSTED = datetime(1980, 1, 6), 1e9  # s, what adjusted GPS time leaves out


class PointCloudsWidget(QWidget):
    """A line of names with a button to add more; with `describes`, a second line says how many files they are."""

    changed = pyqtSignal()

    def __init__(self, parent: QWidget | None = None, describes: bool = True):
        super().__init__(parent)
        self.names = DropLine(self, clearButtonEnabled=True, dropped=self.add, textChanged=self._tell, editingFinished=self._remember_folder,
                              placeholderText=tr("Files, a folder, or wildcards such as /data/B12/*.laz; or drop them here"))
        self.names.textChanged.connect(self.changed)
        self.button = QToolButton(text="…", toolTip=tr("Add point clouds"), popupMode=QToolButton.ToolButtonPopupMode.InstantPopup)
        self.menu = QMenu(self, aboutToShow=self._fill_menu)
        self.button.setMenu(self.menu)
        self.message = wrapped() if describes else None
        if self.message is not None:  # what stands below does not move when the first file is named
            policy = self.message.sizePolicy()
            policy.setRetainSizeWhenHidden(True)
            self.message.setSizePolicy(policy)
        names = QHBoxLayout()
        names.setContentsMargins(0, 0, 0, 0)
        names.addWidget(self.names, 1)
        names.addWidget(self.button)
        column(self, names, *([self.message] if describes else []), rim=0).layout().setSpacing(2)
        self._tell()

    # -- the value ------------------------------------------------------------------------------

    def value(self) -> list[str]:
        """The names, as they were given."""
        return [name.strip() for name in self.names.text().split(SEPARATOR) if name.strip()]

    def set_value(self, value) -> None:
        """Replace the names by one text or several; layers give the files they show."""
        clouds = value if isinstance(value, (list, tuple)) else [value] if value else []
        self.names.setText(f"{SEPARATOR} ".join(_source(cloud) for cloud in clouds))

    def add(self, names: list[str]) -> None:
        """Further names after those that are there."""
        self.set_value(list(dict.fromkeys([*self.value(), *names])))
        self._remember_folder()

    # -- what the button offers -------------------------------------------------------------------

    def _fill_menu(self) -> None:
        self.menu.clear()
        self.menu.addAction(tr("Add files…"), self.choose_files)
        self.menu.addAction(tr("Add a folder…"), self.choose_folder)
        layers = [layer for layer in QgsProject.instance().mapLayers().values() if layer.type() == Qgis.LayerType.PointCloud]
        if layers:
            self.menu.addSection(tr("Point clouds of the project"))
            for name, source in sorted((layer.name(), layer.source()) for layer in layers):
                self.menu.addAction(name, lambda source=source: self.add([source]))

    def choose_files(self) -> None:
        files, _ = QFileDialog.getOpenFileNames(self, tr("Point clouds"), QgsSettings().value(LAST_INPUT, ""), CLOUD_FILTER)
        if files:
            self.add(files)

    def choose_folder(self) -> None:
        folder = QFileDialog.getExistingDirectory(self, tr("Folder of point clouds"), QgsSettings().value(LAST_INPUT, ""))
        if folder:
            self.add([folder])

    def _remember_folder(self) -> None:
        """What is chosen next, such as the trajectory, is looked for where the point clouds lie."""
        paths = [Path(name) for name in self.value()[:1]]
        folders = [path if path.is_dir() else path.parent for path in paths]
        if folders and folders[0].is_absolute() and folders[0].is_dir():
            QgsSettings().setValue(LAST_INPUT, str(folders[0]))

    def _tell(self) -> None:
        if self.message is not None:
            self.message.setText(described(self.value()))
            self.message.setVisible(bool(self.value()))
        self.names.setToolTip("\n".join(self.value()))


class DropLine(QLineEdit):
    """A line on which files, folders and layers can be dropped."""

    dropped = pyqtSignal(list)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if dropped_clouds(event.mimeData()):
            event.acceptProposedAction()
        else:
            super().dragEnterEvent(event)

    def dropEvent(self, event: QDropEvent) -> None:
        names = dropped_clouds(event.mimeData())
        if names:
            self.dropped.emit(names)
            event.acceptProposedAction()
        else:
            super().dropEvent(event)


def dropped_clouds(mime) -> list[str]:
    """Folders and point clouds among what is dropped: from a file manager, the browser or the layer tree."""
    if QgsMimeDataUtils.isUriList(mime):
        paths = [uri.uri for uri in QgsMimeDataUtils.decodeUriList(mime)]
    else:
        paths = [url.toLocalFile() for url in mime.urls() if url.isLocalFile()]
    return [path for path in paths if path and (Path(path).is_dir() or path.lower().endswith((*SUFFIXES, VIRTUAL)))]


def described(given: list[str]) -> str:
    """How many files these names are and how large, or what is wrong with them."""
    try:
        files = [Path(name) for name in cloud_files([_source(name) for name in given], tr("Point clouds"))]
    except RoadExtractionError as problem:
        return str(problem)
    missing = [str(path) for path in files if not path.is_file()]
    if missing:
        return tr("There is no file {name}.").format(name=missing[0])
    size = sum(path.stat().st_size for path in files) / MEGABYTE
    mb = f"{size:,.1f}" if size < 10 else f"{size:,.0f}"
    summary = tr("1 file, {size} MB").format(size=mb) if len(files) == 1 else tr("{count} files, {size} MB").format(count=len(files), size=mb)
    return ", ".join([summary, *_of_headers(files)])


def _of_headers(files):
    """Points, extent, CRS and time of clouds, as their headers say; nothing where one cannot be read, or there are too many."""
    if len(files) > MOST_HEADERS:
        return
    from ..core.survey.las.reader import read_headers

    try:
        headers = read_headers([str(path) for path in files])
    except (RoadExtractionError, OSError):  # the run says why
        return
    yield tr("{count} points").format(count=f"{sum(header.count for header in headers):,}")
    wide, high = (max(header.maximum[axis] for header in headers) - min(header.minimum[axis] for header in headers) for axis in (0, 1))
    yield tr("{width} × {height} m").format(width=f"{wide:,.0f}", height=f"{high:,.0f}")
    names = {QgsCoordinateReferenceSystem.fromWkt(header.crs).userFriendlyIdentifier() for header in headers if header.crs}
    yield " / ".join(sorted(names)) or tr("no CRS")
    yield from _scanned(headers)


def _scanned(headers):
    """When the first point of the first file and the last one of the last file were scanned."""
    from ..core.survey.las.reader import open_cloud

    if not all(header.has_time and header.count for header in headers):
        yield tr("no times")
        return
    times = []
    for header, number in ((headers[0], 0), (headers[-1], headers[-1].count - 1)):
        try:
            with open_cloud(header.path, layers=("gps_time",), known=header) as cloud:
                cloud.seek(number)
                times.append(float(cloud.read_points(1).gps_time[0]))
        except (RoadExtractionError, OSError, ValueError):
            return
    if headers[0].adjusted_time:
        begin, end = (GPS_EPOCH + timedelta(seconds=time + ADJUSTED) for time in times)
        yield tr("scanned {begin} to {end} (GPS time)").format(begin=f"{begin:%Y-%m-%d %H:%M:%S}", end=f"{end:%H:%M:%S}")
    else:
        yield tr("times {begin:.0f} to {end:.0f} s").format(begin=times[0], end=times[1])


def _source(value) -> str:
    """A path as it is; the file of a layer that is given as such or by its id."""
    if hasattr(value, "source"):
        return value.source()
    layer = QgsProject.instance().mapLayer(str(value))
    return str(value) if layer is None else layer.source()


class PointCloudsWrapper(DialogWrapper):
    """The widget in QGIS's dialogs and batches."""

    def createWidget(self, **more):
        widget = PointCloudsWidget(describes=self.dialogType == QgsProcessingGui.WidgetType.Standard)
        widget.changed.connect(self.announce)
        return widget

    def setValue(self, value):
        self.widget.set_value(value)

    def value(self):
        return self.widget.value() or None
