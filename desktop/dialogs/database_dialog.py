"""Where the results of an algorithm go when they all go to one place: a folder, or PostGIS, whose connection and schema a dialog asks for."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    Qgis,
    QgsDataSourceUri,
    QgsProcessingAlgorithm,
    QgsProcessingParameterDefinition,
    QgsProviderConnectionException,
    QgsProviderRegistry,
    QgsVectorLayer,
)
from qgis.gui import QgsProviderConnectionComboBox
from qgis.PyQt.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFormLayout, QLineEdit, QWidget

from ...algorithms.destinations import table_of
from ...processing_provider.texts import tr
from ..widgets import answers, button, wrapped

PROVIDER = "postgres"
GEOMETRY = "geom"
WITH_GEOMETRY = (Qgis.ProcessingSourceType.VectorPoint, Qgis.ProcessingSourceType.VectorLine, Qgis.ProcessingSourceType.VectorPolygon)


class DatabaseDialog(QDialog):
    """The dialog; `choice` is what was chosen."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent, windowTitle=tr("Save the layers to a database"))
        self.connection = QgsProviderConnectionComboBox(PROVIDER)
        self.schema = QComboBox()
        self.connection.connectionChanged.connect(self._other_connection)
        self.prefix = QLineEdit(placeholderText=tr("such as b12_, where one schema holds several surveys"))
        self.problem = wrapped()
        form = QFormLayout(self)
        form.addRow(self.problem)
        form.addRow(tr("Connection"), self.connection)
        form.addRow(tr("Schema"), self.schema)
        form.addRow(tr("Names of the tables begin with"), self.prefix)
        form.addRow(wrapped(tr("One table for each layer; a table of the same name is replaced. The intensity image and the report are files: choose "
                               "a folder for them too.")))
        self.buttons = answers(self, button(tr("New connection…"), self._make_connection))
        form.addRow(self.buttons)
        self.resize(520, self.sizeHint().height())
        self._other_connection(self.connection.currentConnection())

    def _other_connection(self, name):
        """List the schemas of a connection, or say why there are none."""
        self.schema.clear()
        if not name:
            self._say(tr("QGIS knows no connection to a PostgreSQL database yet. <i>New connection…</i> opens the window where one is made."))
            return
        try:
            schemas = [schema for schema in _connection(name).schemas() if schema != "information_schema" and not schema.startswith("pg_")]
        except QgsProviderConnectionException as problem:
            self._say(str(problem))
            return
        self.schema.addItems(sorted(schemas))
        self._say("" if schemas else tr("The database {name} has no schema.").format(name=name))

    def _say(self, text):
        self.problem.setText(text)
        self.problem.setVisible(bool(text))
        self.buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(not text)

    def _make_connection(self):
        from qgis.utils import iface

        self.reject()  # QGIS's window would stay behind this one
        iface.openDataSourceManagerPage(PROVIDER)

    @property
    def choice(self) -> tuple[str, str, str]:
        """Connection, schema, and what the names of the tables begin with."""
        return self.connection.currentConnection(), self.schema.currentText(), self.prefix.text().strip()


def database_destinations(algorithm: QgsProcessingAlgorithm, connection: str, schema: str, prefix: str = "") -> dict[str, str]:
    """Where each layer goes: a table of a schema, with the connection as QGIS knows it."""
    database, result = _connection(connection), {}
    for definition in outputs_by_default(algorithm):
        if definition.type() == "sink":
            uri = QgsDataSourceUri(database.uri())
            uri.setDataSource(schema, prefix + table_name(definition), GEOMETRY if definition.dataType() in WITH_GEOMETRY else "")
            # a password that QGIS keeps apart stays there
            result[definition.name()] = f"{PROVIDER}://{uri.uri(False)}"
    return result


def table_of_database(layer: QgsVectorLayer) -> str:
    """The destination that is the table of a layer."""
    table = QgsDataSourceUri(layer.source())
    uri = QgsDataSourceUri(table.connectionInfo(False))
    uri.setDataSource(table.schema(), table.table(), table.geometryColumn())
    return f"{PROVIDER}://{uri.uri(False)}"


def _connection(name):
    """A connection that QGIS keeps."""
    return QgsProviderRegistry.instance().providerMetadata(PROVIDER).createConnection(name)


# Where the results of an algorithm go when they all go to one place.

def outputs_by_default(algorithm: QgsProcessingAlgorithm) -> list[QgsProcessingParameterDefinition]:
    """The results that are made unless one is left out."""
    return [definition for definition in algorithm.destinationParameterDefinitions() if definition.createByDefault()]


def table_name(definition: QgsProcessingParameterDefinition) -> str:
    """What a result is called in a database, and as a file."""
    return definition.name().split(":")[-1].lower()


def destinations(algorithm: QgsProcessingAlgorithm, folder: str, survey: str = "") -> dict[str, str]:
    """Where each result goes: layers into one GeoPackage called like the algorithm, other files under their own names.

    Where several surveys share the folder, the GeoPackage is called like the survey, and names of other files begin with that.
    """
    result = {}
    for definition in outputs_by_default(algorithm):
        table = table_name(definition)
        if definition.type() == "sink":
            result[definition.name()] = table_of(Path(folder) / f"{survey or algorithm.name()}.gpkg", table)
        else:
            name = f"{survey}_{table}" if survey else table
            result[definition.name()] = str(Path(folder) / f"{name}.{definition.defaultFileExtension()}")
    return result
