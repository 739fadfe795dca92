"""Our own widgets in Processing's dialogs: choices in the user's language, the point clouds of a survey, its trajectory, and columns.

Point clouds are files, folders, wildcards and layers of the project, typed, chosen or dropped.
"""

from __future__ import annotations

import math
from datetime import datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory

from processing.gui.wrappers import WidgetWrapper
from qgis.core import Qgis, QgsCoordinateReferenceSystem, QgsMapLayer, QgsMimeDataUtils, QgsProcessingContext, QgsProject, QgsSettings
from qgis.gui import QgsGui, QgsProcessingGui, QgsProcessingMapLayerComboBox
from qgis.PyQt.QtCore import QSignalBlocker, pyqtSignal
from qgis.PyQt.QtGui import QDragEnterEvent, QDropEvent
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QFileDialog,
    QHBoxLayout,
    QHeaderView,
    QLineEdit,
    QMenu,
    QTableWidget,
    QTableWidgetItem,
    QToolButton,
    QWidget,
)

from ..algorithms.survey_input import FILE_SUFFIXES, SUFFIXES, VIRTUAL, cloud_files, trajectory_path
from ..core.common.errors import RoadExtractionError
from ..core.survey.trajectory.columns import columns_by_role
from ..processing_provider.algorithm import CLOUD_FILTER
from ..processing_provider.texts import told, tr
from .widgets import LAST_INPUT, choices, column, wrapped


class DialogWrapper(WidgetWrapper):
    """A widget for dialogs and batches; the model designer keeps its own, which offers what a model has.

    One that shows another input sets its name, `FOLLOWS`, and has `follow(value)`.
    """

    FOLLOWS = ""

    def __new__(cls, parameter, dialog, *place, **more):
        if type(dialog).__name__ != "ModelerParametersDialog":
            return super().__new__(cls)
        wrapper = QgsGui.processingGuiRegistry().createModelerParameterWidget(dialog.model, dialog.childId, parameter, dialog.context)
        wrapper.setDialog(dialog)
        return wrapper

    def announce(self, *changed):
        """Tell QGIS that the value is another."""
        self.widgetValueHasChanged.emit(self)

    def postInitialize(self, wrappers):
        for wrapper in wrappers:
            if self.FOLLOWS and wrapper.parameterDefinition().name() == self.FOLLOWS:
                wrapper.widgetValueHasChanged.connect(lambda *changed, wrapper=wrapper: self.follow(wrapper.parameterValue()))
                self.follow(wrapper.parameterValue())

    def setWidgetValue(self, value, context):
        self.setValue(value)


class ChoiceWrapper(DialogWrapper):
    """A box with the choices of an enumeration in words."""

    def createWidget(self, **more):
        widget = choices((tr(choice), choice) for choice in self.parameterDefinition().options())
        widget.setCurrentIndex(widget.findData(self.parameterDefinition().defaultValue()))
        widget.currentIndexChanged.connect(self.announce)
        return widget

    def setValue(self, value):
        self.widget.setCurrentIndex(self.widget.findData(value))

    def value(self):
        return self.widget.currentData()


SEPARATOR = ";"
MEGABYTE = 1e6
MOST_HEADERS = 200          # files whose headers are read for the line below the names
GPS_EPOCH, ADJUSTED = datetime(1980, 1, 6), 1e9  # s, what adjusted GPS time leaves out


class PointCloudsWidget(QWidget):
    """A line of names with a button to add more; with `describes`, a second line says how many files they are."""

    changed = pyqtSignal()

    def __init__(self, describes: bool = True):
        super().__init__()
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


# The trajectory in dialogs: a layer that looks like one is offered first, and where there is none, nothing is.

CLOUDS = "POINT_CLOUDS"
MOST_TABLES = 20  # files beside the point clouds that are looked into
BEGINNING = 2**18  # bytes of each: some thousand positions
TREES = (".gpx", ".kml")  # that are nothing without their ends


class TrajectoryWrapper(DialogWrapper):
    """QGIS's own choice of layers, which begins with the trajectory of the project instead of its first layer."""

    FOLLOWS = "POINT_CLOUDS"

    def createWidget(self, **more):
        self._offered = ""  # file that was found beside the point clouds
        # only a parameter that may stay empty is shown empty
        shown = self.parameterDefinition().clone()
        owner = self.parameterDefinition().algorithm()
        # with point clouds it is that of the survey, although some algorithms can do without
        self.offered = not shown.flags() & Qgis.ProcessingParameterFlag.Optional or \
            owner is not None and owner.parameterDefinition("POINT_CLOUDS") is not None
        shown.setFlags(shown.flags() | Qgis.ProcessingParameterFlag.Optional)
        widget = QgsProcessingMapLayerComboBox(shown, self.dialogType)
        widget.valueChanged.connect(self.announce)
        return widget

    def setWidgetContext(self, context):
        self.widget.setWidgetContext(context)
        super().setWidgetContext(context)
        if self.offered and self.widget.value() is None:
            likely = trajectory_of(QgsProject.instance(), context.activeLayer())
            if likely is not None:
                self.widget.setLayer(likely)

    def follow(self, clouds) -> None:
        """Offer the trajectory beside point clouds; one that was offered for others gives way."""
        if self.widget.value() not in (None, "", self._offered):
            return
        likely = trajectory_beside([str(name) for name in clouds or []])
        if likely:
            self.setValue(likely)
        elif self._offered:
            for box in self.widget.findChildren(QComboBox):
                box.setCurrentIndex(-1)  # QGIS's own way to no layer does nothing while a file is chosen
        self._offered = likely

    def setWidgetValue(self, value, context):
        self.widget.setValue(value, context)

    def setValue(self, value):
        self.widget.setValue(value, QgsProcessingContext())

    def value(self):
        return self.widget.value()


def trajectory_of(project: QgsProject, active: QgsMapLayer | None = None) -> QgsMapLayer | None:
    """The layer of a project that looks like a trajectory: the active one, else the only one."""
    layers = [layer for layer in project.mapLayers().values() if looks_like_a_trajectory(layer)]
    if active in layers:
        return active
    return layers[0] if len(layers) == 1 else None


def trajectory_beside(clouds: list[str]) -> str:
    """The file in the folder of point clouds that holds a trajectory, in whatever dresses; "" where there is none, or more than one."""
    try:
        folders = {Path(path).absolute().parent for path in cloud_files(clouds, CLOUDS)}
    except RoadExtractionError:
        return ""
    if len(folders) != 1 or not (folder := folders.pop()).is_dir():
        return ""
    tables = sorted(path for path in folder.iterdir() if path.is_file() and path.suffix.lower() in FILE_SUFFIXES)
    begins = {str(path): place for path in tables[:MOST_TABLES] if (place := _first_place(path))}
    return next(iter(begins)) if len(set(begins.values())) == 1 else ""


def _first_place(path):
    """Where a trajectory begins, to a metre; None of another file. To read all positions of a long drive would make the window wait."""
    from ..core.survey.trajectory.reader import read_trajectory

    try:
        with open(path, "rb") as file:
            head = file.read(None if path.suffix.lower() in TREES else BEGINNING)
        with TemporaryDirectory() as folder:
            beginning = Path(folder) / path.name
            beginning.write_bytes(head[:head.rfind(b"\n") + 1] if len(head) == BEGINNING and b"\0" not in head else head)
            drive = read_trajectory(str(beginning))
            return (round(drive.x[0]), round(drive.y[0])) if len(drive) > 1 else None
    except (RoadExtractionError, OSError, ValueError):
        return None


def looks_like_a_trajectory(layer: QgsMapLayer) -> bool:
    """Whether a layer has points or rows with times; what a road map consists of has none."""
    if layer.type() != Qgis.LayerType.Vector or layer.geometryType() not in (Qgis.GeometryType.Point, Qgis.GeometryType.Null):
        return False
    return "time" in columns_by_role([field.name() for field in layer.fields()])


# The columns of a trajectory's text file: what was understood, and a table in which they are assigned by hand.

ROWS = 4            # of the file that are shown
SKIPPED = "-"
SYSTEMS = {"gps": tr("GPS seconds since 1980"), "adjusted": tr("adjusted GPS seconds"), "week": tr("seconds of the week, most likely"),
           "": tr("seconds of the day or from the start: the point clouds tell")}
ROLE_TITLES = {"": tr("left out"), "time": tr("time"), "x": tr("x (east)"), "y": tr("y (north)"), "z": tr("z (height)"), "roll": tr("roll"),
               "pitch": tr("pitch"), "heading": tr("heading"), "lon": tr("longitude"), "lat": tr("latitude"),
               "gps": tr("time, GPS clock"), "utc": tr("time, UTC clock"), "week": tr("GPS week"), "date": tr("date")}


class ColumnsWidget(QWidget):
    """A line with the roles, the first rows of the file below boxes that set them, and what was understood."""

    def __init__(self):
        super().__init__()
        self.path = ""
        self.line = QLineEdit(placeholderText=tr("Recognised from the file"), clearButtonEnabled=True, textChanged=lambda text: self._read())
        self.table = QTableWidget(editTriggers=QTableWidget.EditTrigger.NoEditTriggers)
        self.table.verticalHeader().hide()
        self.table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.message = wrapped()
        self.boxes: list[QComboBox] = []
        column(self, self.line, self.table, self.message, rim=0)
        self._show_nothing()

    def value(self) -> str:
        """The roles, as the parameter takes them."""
        return self.line.text().strip()

    def show_file(self, path: str) -> None:
        """Show another file; "" for none. What was assigned belongs to the file before."""
        if path == self.path:
            return
        if self.path:
            with QSignalBlocker(self.line):
                self.line.clear()
        self.path = path
        self._read()

    def _show_nothing(self):
        self.table.hide()
        self.message.hide()

    def _read(self):
        from ..core.survey.trajectory.meaning import columns_of_table, facts_of
        from ..core.survey.trajectory.reader import read_trajectory

        if not self.path:
            self._show_nothing()
            return
        try:
            columns = columns_of_table(self.path, self.value(), ROWS)
        except RoadExtractionError as problem:
            # an SBET has no columns to assign
            self.table.hide()
            try:
                self._say(_described_drive(facts_of(read_trajectory(self.path))))
            except RoadExtractionError:
                self._say(told(str(problem)), wrong=True)
            return
        self._fill(columns)
        try:
            self._say(_described_drive(facts_of(read_trajectory(self.path, columns=self.value()))))
        except RoadExtractionError as problem:
            self._say(told(columns.problem or str(problem)), wrong=True)

    def _fill(self, table):
        count = len(table.roles)
        # while the user writes, words that are not yet whole leave the boxes as they are
        roles = [box.currentData() for box in self.boxes] if table.problem and len(self.boxes) == count else list(table.roles)
        self.table.clear()
        self.table.setColumnCount(count)
        self.table.setRowCount(1 + len(table.rows))
        self.table.setHorizontalHeaderLabels([title or tr("Column {number}").format(number=k + 1) for k, title in enumerate(table.titles)])
        self.boxes = []
        for k, role in enumerate(roles):
            box = choices((title, name) for name, title in ROLE_TITLES.items())
            box.setCurrentIndex(box.findData(role))
            box.activated.connect(lambda index: self._assigned())
            self.table.setCellWidget(0, k, box)
            self.boxes.append(box)
            for row, values in enumerate(table.rows, start=1):
                self.table.setItem(row, k, QTableWidgetItem(values[k]))
        self.table.resizeColumnsToContents()
        height = self.table.horizontalHeader().sizeHint().height() + sum(self.table.rowHeight(row) for row in range(self.table.rowCount()))
        self.table.setFixedHeight(height + self.table.horizontalScrollBar().sizeHint().height() + 4)
        self.table.show()

    def _assigned(self):
        """Write what the boxes say; a role that was given to another column is taken from its former one."""
        chosen = self.sender()
        for box in self.boxes:
            if box is not chosen and isinstance(chosen, QComboBox) and box.currentData() == chosen.currentData():
                box.setCurrentIndex(box.findData(""))
        self.line.setText(",".join(box.currentData() or SKIPPED for box in self.boxes))

    def _say(self, text, wrong=False):
        self.message.setText(text)
        self.message.setStyleSheet("color: #b00020" if wrong else "")
        self.message.show()


def _described_drive(facts):
    """What was understood of a trajectory, in a line or two."""
    text = tr("{count} positions over {length} m, heights {low:.1f} to {high:.1f} m").format(
        count=f"{facts.positions:,}", length=f"{facts.length:,.0f}", low=facts.low, high=facts.high)
    if not math.isfinite(facts.seconds):
        return text + "; " + tr("no time")
    return text + "; " + tr("{seconds:.0f} s, {speed:.0f} km/h in the median; time: {system}").format(
        seconds=facts.seconds, speed=3.6 * facts.speed, system=SYSTEMS[facts.system])


class ColumnsWrapper(DialogWrapper):
    """The widget in QGIS's dialogs; a batch has the line alone."""

    FOLLOWS = "INPUT"

    def createWidget(self, **more):
        whole = self.dialogType == QgsProcessingGui.WidgetType.Standard
        widget = ColumnsWidget() if whole else QLineEdit()
        self.line = widget.line if whole else widget
        self.line.textChanged.connect(self.announce)
        return widget

    def follow(self, value) -> None:
        """Show the file that an input names; a layer has fields with names."""
        source = value.source.staticValue() if hasattr(value, "source") and hasattr(value.source, "staticValue") else value
        path = trajectory_path(source)
        if isinstance(self.widget, ColumnsWidget):
            self.widget.show_file(str(path) if path is not None and path.is_file() else "")

    def setValue(self, value):
        self.line.setText(value or "")

    def value(self):
        return self.line.text().strip()
