"""The trajectory in dialogs: a layer that looks like one is offered first, and where there is none, nothing is."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from qgis.core import Qgis, QgsMapLayer, QgsProcessingContext, QgsProject
from qgis.gui import QgsProcessingMapLayerComboBox
from qgis.PyQt.QtWidgets import QComboBox

from ..algorithms.survey_files import FILE_SUFFIXES, cloud_files
from ..core.common.errors import RoadExtractionError
from ..core.survey.trajectory.columns import columns_by_role
from .dialog_wrapper import DialogWrapper

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
    """The one file in the folder of point clouds that holds a trajectory; "" where there is none, or more than one."""
    try:
        folders = {Path(path).absolute().parent for path in cloud_files(clouds, CLOUDS)}
    except RoadExtractionError:
        return ""
    if len(folders) != 1 or not (folder := folders.pop()).is_dir():
        return ""
    tables = sorted(path for path in folder.iterdir() if path.is_file() and path.suffix.lower() in FILE_SUFFIXES)
    usable = [str(path) for path in tables[:MOST_TABLES] if _is_a_trajectory(path)]
    return usable[0] if len(usable) == 1 else ""


def _is_a_trajectory(path):
    """Whether a file begins like one: to read all positions of a long drive would make the window wait."""
    from ..core.survey.trajectory.reader import read_trajectory

    try:
        with open(path, "rb") as file:
            head = file.read(None if path.suffix.lower() in TREES else BEGINNING)
        with TemporaryDirectory() as folder:
            beginning = Path(folder) / path.name
            beginning.write_bytes(head[:head.rfind(b"\n") + 1] if len(head) == BEGINNING and b"\0" not in head else head)
            return len(read_trajectory(str(beginning))) > 1
    except (RoadExtractionError, OSError, ValueError):
        return False


def looks_like_a_trajectory(layer: QgsMapLayer) -> bool:
    """Whether a layer has points or rows with times; what a road map consists of has none."""
    if layer.type() != Qgis.LayerType.Vector or layer.geometryType() not in (Qgis.GeometryType.Point, Qgis.GeometryType.Null):
        return False
    return "time" in columns_by_role([field.name() for field in layer.fields()])
