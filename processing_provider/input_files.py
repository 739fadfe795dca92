"""Which files a run reads, so that none of them is written over; and tables put into a database that programs have open."""

import os
from pathlib import Path

from qgis.core import QgsDataSourceUri, QgsMapLayer, QgsProcessingFeatureSourceDefinition, QgsProcessingUtils, QgsProviderRegistry

from ..algorithms.destinations import destination_path
from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import check_local, gdal_exceptions
from ..core.lazy import gdal
from .texts import tr

OPENED_BY_QGIS = ("source", "vector", "raster", "layer")
READ = ("source", "vector", "raster", "layer", "multilayer", "file", "pointcloud")


def input_files(algorithm, parameters, context):
    """[(path, table or "", label)] of every file that the inputs name and that is there."""
    return [(path, table, definition.description()) for definition in _inputs(algorithm, READ)
            for path, table in map(_file_of, _sources(parameters.get(definition.name()), context)) if path is not None]


def _inputs(algorithm, kinds):
    return [definition for definition in algorithm.parameterDefinitions() if definition.type() in kinds and not definition.isDestination()]


def written_over(destination, path, inputs):
    """The label of the input whose file or table the destination value would replace, or ""."""
    table = QgsDataSourceUri(destination.removeprefix("ogr:")).table() if destination.startswith("ogr:") else ""
    for source, read, label in inputs:
        if path.exists() and os.path.samefile(path, source) and (not table or table == (read or _first_table(source))):
            return label
    return ""


def layer_file(value, context):
    """The file of a point cloud that a value names: a path, or a layer, its name or its id in the project; else the value as text."""
    return next(iter(_sources(value, context)), str(value))


def check_files(algorithm, parameters, context):
    """Raise RoadExtractionError where an input names a file that describes data elsewhere, which QGIS would fetch."""
    for definition in _inputs(algorithm, OPENED_BY_QGIS):
        value = _static(parameters.get(definition.name()), context)
        file = value.partition("|")[0] if isinstance(value, str) else ""
        if file and os.path.isfile(file):
            check_local(file)


def _static(value, context):
    """A value without what QGIS may put about it: whether the selected features alone are meant, for example."""
    return value.source.valueAsString(context.expressionContext())[0] if isinstance(value, QgsProcessingFeatureSourceDefinition) else value


def asks_servers(algorithm, parameters, context):
    """Whether an input is a layer that the user has from a server, which is then asked; for files, nothing is fetched."""
    sources = [source for definition in _inputs(algorithm, READ) for source in _sources(parameters.get(definition.name()), context)]
    return any("://" in source or "/vsi" in source.lower() for source in sources if not os.path.exists(source))


def close_database(destination, context):
    """Let go of the layers that were read, for this run alone, from the database that a table is about to be added to.

    QGIS would look for the new table in the connection it has open, and not find it there.
    """
    path = destination_path(destination)
    if path is None or not destination.startswith("ogr:") or not path.exists():
        return
    store = context.temporaryLayerStore()
    for layer in list(store.mapLayers().values()):
        read, _ = _file_of(layer.source())
        if read is not None and os.path.samefile(read, path):
            store.removeMapLayer(layer.id())


def _sources(value, context):
    """The sources of the layers and files that a parameter's value names."""
    if isinstance(value, (list, tuple)):
        return [source for item in value for source in _sources(item, context)]
    value = _static(value, context)
    if isinstance(value, QgsMapLayer):
        return [value.source()]
    if not isinstance(value, str) or not value:
        return []
    layer = None if os.path.exists(value) else QgsProcessingUtils.mapLayerFromString(value, context, False)
    return [value if layer is None else layer.source()]


def _file_of(source):
    """(Path, table) of a source that is a file, or (None, "")."""
    parts = QgsProviderRegistry.instance().decodeUri("ogr", source)
    path = Path(parts.get("path") or source)
    try:
        return (path, parts.get("layerName") or "") if path.is_file() else (None, "")
    except OSError:  # a name too long to be one
        return None, ""


def _first_table(path):
    """The table that is read where a database is named alone."""
    tables = QgsProviderRegistry.instance().querySublayers(str(path))
    return tables[0].name() if tables else ""


# Tables of one GeoPackage put into another that stays where it is, since programs have it open.

def add_tables(written, path):
    """Put all tables of a database into another, in one transaction: whatever ends the program leaves those of before or these.

    Tables of the same names are replaced. Programs that have the database open, this QGIS too, read the new tables from then on.

    written, path : Path
    Raises RoadExtractionError if another program keeps the database locked, or there is no room; then the tables of before stand.
    """
    try:
        with gdal_exceptions():
            target = gdal.OpenEx(str(path), gdal.OF_VECTOR | gdal.OF_UPDATE)
            # one transaction from the first table to the last, and none in between
            gdal.VectorTranslate(target, str(written), accessMode="overwrite", options=["-preserve_fid", "-gt", "unlimited"])
            target = None
    except RuntimeError as problem:
        raise RoadExtractionError(
            tr("The result could not be written: {reason}. Is the disk full or the file open elsewhere?").format(reason=problem)) from problem
