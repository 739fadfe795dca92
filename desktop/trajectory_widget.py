"""The trajectory in dialogs: a layer that looks like one is offered first, and where there is none, nothing is."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory

from qgis.core import Qgis, QgsMapLayer, QgsProcessingContext, QgsProject
from qgis.gui import QgsProcessingGui, QgsProcessingMapLayerComboBox
from qgis.PyQt.QtCore import QSignalBlocker, pyqtSignal
from qgis.PyQt.QtWidgets import QComboBox, QHeaderView, QLineEdit, QTableWidget, QTableWidgetItem, QWidget

from ..algorithms.survey_files import FILE_SUFFIXES, cloud_files, trajectory_path
from ..core.common.errors import RoadExtractionError
from ..core.survey.trajectory.columns import columns_by_role
from ..processing_provider.texts import told, tr
from .dialog_wrapper import DialogWrapper
from .widgets import choices, column, wrapped

CLOUDS = "POINT_CLOUDS"
MOST_TABLES = 20  # files beside the point clouds that are looked into
BEGINNING = 2**18  # bytes of each: some thousand positions
TREES = (".gpx", ".kml")  # that are nothing without their ends


class TrajectoryWrapper(DialogWrapper):
    """QGIS's own choice of layers, which begins with the trajectory of the project instead of its first layer."""

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

    def postInitialize(self, wrappers):
        """Follow the point clouds: the one trajectory that lies beside them is offered, where none is chosen."""
        for wrapper in wrappers:
            if wrapper.parameterDefinition().name() == CLOUDS:
                wrapper.widgetValueHasChanged.connect(lambda *changed, wrapper=wrapper: self.follow(wrapper.parameterValue()))

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

    changed = pyqtSignal()

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.path = ""
        self.line = QLineEdit(placeholderText=tr("Recognised from the file"), clearButtonEnabled=True, textChanged=lambda text: self._read())
        self.line.textChanged.connect(lambda text: self.changed.emit())
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

    def set_value(self, value: str) -> None:
        self.line.setText(value or "")

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
                self._say(described(facts_of(read_trajectory(self.path))))
            except RoadExtractionError:
                self._say(told(str(problem)), wrong=True)
            return
        self._fill(columns)
        try:
            self._say(described(facts_of(read_trajectory(self.path, columns=self.value()))))
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


def described(facts) -> str:
    """What was understood of a trajectory, in a line or two."""
    text = tr("{count} positions over {length} m, heights {low:.1f} to {high:.1f} m").format(
        count=f"{facts.positions:,}", length=f"{facts.length:,.0f}", low=facts.low, high=facts.high)
    if not math.isfinite(facts.seconds):
        return text + "; " + tr("no time")
    return text + "; " + tr("{seconds:.0f} s, {speed:.0f} km/h in the median; time: {system}").format(
        seconds=facts.seconds, speed=3.6 * facts.speed, system=SYSTEMS[facts.system])


class ColumnsWrapper(DialogWrapper):
    """The widget in QGIS's dialogs; a batch has the line alone."""

    def createWidget(self, **more):
        whole = self.dialogType == QgsProcessingGui.WidgetType.Standard
        widget = ColumnsWidget() if whole else QLineEdit()
        (widget.changed if whole else widget.textChanged).connect(self.announce)
        return widget

    def postInitialize(self, wrappers):
        """Follow the input that names the file."""
        for wrapper in wrappers:
            if isinstance(self.widget, ColumnsWidget) and wrapper.parameterDefinition().name() == "INPUT":
                wrapper.widgetValueHasChanged.connect(lambda *changed, wrapper=wrapper: self.follow(wrapper.parameterValue()))
                self.follow(wrapper.parameterValue())

    def follow(self, value) -> None:
        """Show the file that an input names; a layer has fields with names."""
        source = value.source.staticValue() if hasattr(value, "source") and hasattr(value.source, "staticValue") else value
        path = trajectory_path(source)
        self.widget.show_file(str(path) if path is not None and path.is_file() else "")

    def setValue(self, value):
        if isinstance(self.widget, ColumnsWidget):
            self.widget.set_value(value or "")
        else:
            self.widget.setText(value or "")

    def value(self):
        return self.widget.value() if isinstance(self.widget, ColumnsWidget) else self.widget.text()
