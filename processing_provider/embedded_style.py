"""Styles that travel with a result, so that a file made without a window opens styled anywhere."""

from pathlib import Path

from qgis.core import Qgis, QgsApplication, QgsDataSourceUri, QgsProviderConnectionException, QgsProviderRegistry, QgsRasterLayer, QgsVectorLayer

from ..algorithms.destinations import destination_path
from .results.origin import describe_origin
from .styling import LOOKS, STYLES, apply_style

NAME = "default"
POSTGIS = "postgres://"


def embed_style(name, dest, title, schema=(), provenance=None):
    """Give the result `dest` of the output `name` its style, and the note of where it comes from: in the database, or beside the raster.

    Other formats have no room for one. A style that cannot be kept costs a look, not the result, so nothing is raised.
    """
    path = destination_path(dest)
    look, _ = LOOKS.get(name, (None, None))
    qml = STYLES / f"{look}.qml"
    if dest.startswith(POSTGIS):
        _in_the_database(QgsVectorLayer(dest.removeprefix(POSTGIS), title, "postgres"), title, qml, schema, name, provenance)
    if path is None or look is None or not qml.exists():
        return
    if path.suffix.lower() in (".tif", ".tiff"):
        _beside_the_raster(path, qml)
    elif path.suffix.lower() == ".gpkg":
        _in_the_database(QgsVectorLayer(_layer_uri(dest, path), title, "ogr"), title, qml, schema, name, provenance)


def _beside_the_raster(path, qml):
    layer = QgsRasterLayer(str(path), path.stem)
    if layer.isValid():
        apply_style(layer, qml)
        layer.saveNamedStyle(str(path.with_suffix(".qml")))  # QGIS looks for it under this name


def _in_the_database(layer, title, qml, schema, output, provenance):
    if not layer.isValid():
        return
    if provenance is not None and layer.providerType() == "postgres":
        _comment_on_table(layer, "\n".join(provenance.history(output)))
    elif provenance is not None:
        describe_origin(layer, provenance, output)
        layer.saveDefaultMetadata()  # into the package
    apply_style(layer, qml, schema, output)
    # The style of an earlier run into the same table would win
    count, ids, names, _, _ = layer.listStylesInDatabase()
    for number in range(max(count, 0)):
        if names[number] == NAME:
            layer.deleteStyleFromDatabase(ids[number])
    save = getattr(layer, "saveStyleToDatabaseV2", None) or layer.saveStyleToDatabase
    save(NAME, title, True, "")


def _comment_on_table(layer, text):
    """What PostgreSQL keeps of a table, and QGIS shows as its abstract. QGIS's own way makes a table of its own in every schema."""
    uri = QgsDataSourceUri(layer.source())
    name, quoted = uri.quotedTablename(), text.replace("'", "''")
    try:
        connection = QgsProviderRegistry.instance().providerMetadata("postgres").createConnection(uri.connectionInfo(True), {})
        connection.executeSql(f"COMMENT ON TABLE {name} IS '{quoted}'")
    except QgsProviderConnectionException as problem:
        QgsApplication.messageLog().logMessage(str(problem), "Lanewright", Qgis.MessageLevel.Warning, False)


def _layer_uri(dest, path):
    """The layer of a destination as the OGR provider opens it."""
    if dest.startswith("ogr:"):
        return f"{path}|layername={QgsDataSourceUri(dest.removeprefix('ogr:')).table()}"
    return dest if "|" in dest else f"{path}|layername={Path(path).stem}"
