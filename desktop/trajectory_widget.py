"""The trajectory in dialogs: a layer that looks like one is offered first, and where there is none, nothing is."""

from __future__ import annotations

from qgis.core import Qgis, QgsMapLayer, QgsProcessingContext, QgsProject
from qgis.gui import QgsProcessingMapLayerComboBox

from ..core.survey.trajectory.columns import columns_by_role
from .dialog_wrapper import DialogWrapper


class TrajectoryWrapper(DialogWrapper):
    """QGIS's own choice of layers, which begins with the trajectory of the project instead of its first layer."""

    def createWidget(self, **more):
        # only a parameter that may stay empty is shown empty
        shown = self.parameterDefinition().clone()
        owner = self.parameterDefinition().algorithm()
        # with point clouds it is that of the survey, although some algorithms can do without
        self.offered = not shown.flags() & Qgis.ProcessingParameterFlag.Optional or \
            owner is not None and owner.parameterDefinition("POINT_CLOUDS") is not None
        shown.setFlags(shown.flags() | Qgis.ProcessingParameterFlag.Optional)
        widget = QgsProcessingMapLayerComboBox(shown, self.dialogType)
        widget.valueChanged.connect(lambda: self.widgetValueHasChanged.emit(self))
        return widget

    def setWidgetContext(self, context):
        self.widget.setWidgetContext(context)
        super().setWidgetContext(context)
        if self.offered and self.widget.value() is None:
            likely = trajectory_of(QgsProject.instance(), context.activeLayer())
            if likely is not None:
                self.widget.setLayer(likely)

    def setWidgetValue(self, value, context):
        self.widget.setValue(value, context)

    def setValue(self, value):
        self.widget.setValue(value, QgsProcessingContext())

    def value(self):
        return self.widget.value()


def trajectory_of(project: QgsProject, active: QgsMapLayer | None = None) -> QgsMapLayer | None:
    """The layer of a project that looks like a trajectory: the active one, else the only one."""
    found = [layer for layer in project.mapLayers().values() if looks_like_a_trajectory(layer)]
    if active in found:
        return active
    return found[0] if len(found) == 1 else None


def looks_like_a_trajectory(layer: QgsMapLayer) -> bool:
    """Whether a layer has points or rows with times; what a road map consists of has none."""
    if layer.type() != Qgis.LayerType.Vector or layer.geometryType() not in (Qgis.GeometryType.Point, Qgis.GeometryType.Null):
        return False
    return "time" in columns_by_role([field.name() for field in layer.fields()])
