"""Vector files without QGIS: layers read and written by fiona, lines with measures (M), which it leaves out, by GDAL's own Python module."""

import logging
import sqlite3
from contextlib import closing, contextmanager
from importlib.util import find_spec
from pathlib import Path

from ..algorithms.destinations import package_and_table
from ..algorithms.rooms import core
from ..algorithms.vector_source import KIND_OF, LINE, POINT, POLYGON, TABLE, UNKNOWN, VectorSource, crs_to_write, plain_value
from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import OFFLINE, VECTOR_DRIVERS, check_crs_of_geojson, gdal_exceptions, open_vector
from ..core.lazy import fiona, gdal, np, ogr, osr, shapely

DRIVERS = {"gpkg": "GPKG", "fgb": "FlatGeobuf", "shp": "ESRI Shapefile", "geojson": "GeoJSON"}
GEOMETRIES = {name: name if name == "None" else f"3D {name[:-1]}" for name in KIND_OF}   # fiona has none with measures
KINDS = {"Point": POINT, "LineString": LINE, "Polygon": POLYGON, "None": TABLE}
COLUMN_TYPES = {int: "int64", float: "float", str: "str"}


def _shape(geometry):
    """A geometry of fiona as shapely has it; lines and areas by arrays, whose coordinates shapely does not look at one by one."""
    if geometry.type == "LineString":
        return shapely.LineString(np.array(geometry.coordinates))
    if geometry.type == "Polygon" and geometry.coordinates:
        outline, *holes = (np.array(ring) for ring in geometry.coordinates)
        return shapely.Polygon(outline, holes)
    return shapely.geometry.shape(geometry)


def file_and_table(value):
    """(path, table or "") of `map.gpkg`, `map.gpkg|layername=lanes` or `ogr:dbname='map.gpkg' table="lanes" (geom)`."""
    if package := package_and_table(value):
        return package
    path, *options = value.split("|")
    names = [option.partition("=")[2] for option in options if option.startswith("layername=")]
    return path, names[0] if names else ""


def _fiona_errors():
    """What fiona raises where a file is not as it should be."""
    from fiona._err import CPLE_BaseError  # what GDAL reports is raised as this since fiona 1.10, which has no public name for it
    from fiona.errors import FionaError, FionaValueError

    return FionaError, FionaValueError, CPLE_BaseError, OSError


def first_table(path):
    """The table that is read where a file is named alone."""
    try:
        with _opened(str(path), None) as layer:
            return layer.name
    except _fiona_errors():
        return ""


@contextmanager
def _opened(path, table):
    """A layer of a file, for reading; nothing is fetched for it."""
    with fiona.Env(**OFFLINE), fiona.open(path, layer=table, enabled_drivers=list(VECTOR_DRIVERS)) as layer:
        yield layer


class LayerFile(VectorSource):
    """A layer of a file; `value` names it, `label` is the parameter's."""

    def __init__(self, value, label):
        self.label, self.value = label, value
        self.path, table = file_and_table(value)
        if not Path(self.path).exists():
            raise RoadExtractionError(f"{label}: there is no file {self.path}. Check the name and the folder.")
        self.table = table or None
        try:
            with _opened(self.path, self.table) as layer:
                self.table = layer.name
                self.names = list(layer.schema["properties"])
                geometry = layer.schema["geometry"]
                # a GeoPackage has entries of its own for layers without a CRS
                named = layer.crs_wkt and not core.io.crs.parse_crs(layer.crs_wkt).name.lower().startswith("undefined ")
                self.stored_crs = layer.crs_wkt if named else ""
                if layer.driver == "GeoJSON":
                    with fiona.open(self.path, layer=self.table, NATIVE_DATA="YES") as native:
                        check_crs_of_geojson(self.path, native.tags(ns="NATIVE_DATA").get("NATIVE_DATA"))
        except (*_fiona_errors(), ValueError) as problem:
            raise RoadExtractionError(f"{label}: {value} cannot be read as a vector layer ({problem}).") from problem
        plain = geometry.replace("3D ", "").replace("Multi", "")
        self.kind = KINDS.get(plain, UNKNOWN)
        self.has_z = geometry.startswith("3D")
        # fiona leaves measures out
        self.has_m = self.kind == LINE and self.has_z and _may_have_measures(self.path, self.table)

    def stored_rows(self, measures=False, check_validity=True):
        if measures and self.has_m:
            for number, wkb, values in _measured_rows(self.path, self.table, self.names, self.label):
                self.feature_id = number
                yield wkb, values
            return
        for record in self._records():
            self.feature_id = record["id"]
            try:
                geometry = None if record["geometry"] is None else _shape(record["geometry"])
            except (shapely.errors.GEOSException, ValueError):   # lines of one vertex, rings of three
                wkb = b""
            else:
                # 2D parts of a layer with heights stay flat, as they are
                wkb = None if geometry is None or geometry.is_empty else shapely.to_wkb(geometry, output_dimension=3, flavor="iso")
            yield wkb, [record["properties"][name] for name in self.names]

    def rows_where(self, condition):
        """Whether a condition of OGR's SQL holds, for every row."""
        from fiona.errors import AttributeFilterError

        with _opened(self.path, self.table) as layer, _reported_errors() as problems:
            try:
                ids = {record["id"] for record in layer.filter(where=condition)}
            except (AttributeFilterError, *_fiona_errors()) as problem:
                problems.append(str(problem))
        if problems:
            raise RoadExtractionError(f"{condition!r} is no condition on the fields {', '.join(self.names)} of {self.label} ({problems[0]}). "
                                      "Outside QGIS it is one of SQL, such as \"type\" = 'driveway'.")
        return [record["id"] in ids for record in self._records()]

    def _records(self):
        try:
            with _opened(self.path, self.table) as layer:
                yield from layer
        except (TypeError, UnicodeDecodeError) as problem:   # what fiona comes to where a text cannot be decoded
            raise RoadExtractionError(f"{self.label}: {self.path} holds texts that are not in UTF-8, and its format has no other. Convert the file "
                                      "to UTF-8, as a text editor does.") from problem


@contextmanager
def _reported_errors():
    """A list of what GDAL's drivers report as errors meanwhile: of a faulty condition on a GeoPackage fiona before 1.10 only writes a log."""
    problems = []
    handler = logging.Handler(logging.ERROR)
    handler.emit = lambda record: problems.append(record.getMessage())
    logger = logging.getLogger("fiona._env")
    before = logger.propagate
    logger.addHandler(handler)
    logger.propagate = False
    try:
        yield problems
    finally:
        logger.removeHandler(handler)
        logger.propagate = before


def write_layer(path, table, features, check_cancelled):
    """Write Features into a file that is new, in the format of its ending, or add them to a GeoPackage as a table, "" for that of the file.

    `check_cancelled` is called now and then and may raise Cancelled.
    """
    if features.geometry_type.endswith("ZM"):
        _write_measured(path, table, features, check_cancelled)
        return

    driver = DRIVERS[Path(path).suffix.lower().lstrip(".")]
    schema = {"geometry": GEOMETRIES[features.geometry_type], "properties": {field.name: COLUMN_TYPES[field.type] for field in features.schema}}
    options = {"layer": table or Path(path).stem, "description": features.description} if driver == "GPKG" else {}
    if wkt := crs_to_write(features, driver):
        options["crs_wkt"] = wkt
    try:
        with fiona.open(path, "w", driver=driver, schema=schema, encoding="utf-8", **options) as layer:
            layer.writerecords(_records_of(features, check_cancelled))
    except _fiona_errors() as problem:
        raise RoadExtractionError(f"The result could not be written: {problem}. Is the disk full or the file open elsewhere?") from problem


def _records_of(features, check_cancelled):
    names = [field.name for field in features.schema]
    for number, (geometry, row) in enumerate(features):
        if number % 5000 == 0:
            check_cancelled()
        yield {"geometry": None if geometry is None else shapely.geometry.mapping(geometry),
               "properties": {name: plain_value(row.get(name)) for name in names}}


# Lines with measures.

MEASURED = {".gpkg": "GPKG", ".shp": "ESRI Shapefile"}  # formats that keep measures


def check_gdal(why):
    """Raise RoadExtractionError, with what to install, where GDAL's Python module is missing; `why` it is needed begins the sentence."""
    if find_spec("osgeo") is None:
        raise RoadExtractionError(
            f"{why[0].upper()}{why[1:]}, which needs GDAL's Python module (osgeo), and it is not installed. Install lanewright[gdal] with pip, gdal "
            "from conda-forge, or python3-gdal on Debian and Ubuntu.")


def _may_have_measures(path, table):
    """Whether a layer of lines has measures; where GDAL's Python module is missing, also True where nobody can tell."""
    if find_spec("osgeo") is not None:
        dataset = open_vector(path)
        layer = None if dataset is None else dataset.GetLayerByName(table)
        return layer is not None and bool(ogr.GT_HasM(layer.GetGeomType()))
    suffix = Path(path).suffix.lower()
    if suffix == ".gpkg":
        with closing(sqlite3.connect(f"{Path(path).absolute().as_uri()}?mode=ro", uri=True)) as database:
            row = database.execute("SELECT m FROM gpkg_geometry_columns WHERE table_name = ?", (table,)).fetchone()
        return bool(row and row[0])
    return suffix not in (".geojson", ".json")


def check_format(path, label):
    """Raise RoadExtractionError, before the work, where lines with measures cannot be written to a file."""
    check_gdal(f"{label} are lines with measures")
    if Path(path).suffix.lower() not in MEASURED:
        raise RoadExtractionError(f"{label} was to be written to {path}, but they are lines with measures. Write a GeoPackage (.gpkg).")


def _measured_rows(path, table, names, label):
    """(feature id, ISO WKB or None, values) of every row, as VectorSource gives them."""
    check_gdal(f"{label} has lines with measures")

    dataset = open_vector(path)
    layer = dataset.GetLayerByName(table)
    for feature in layer:
        geometry = feature.GetGeometryRef()
        wkb = None if geometry is None or geometry.IsEmpty() else bytes(geometry.ExportToIsoWkb(ogr.wkbNDR))
        yield feature.GetFID(), wkb, [feature.GetField(name) for name in names]


def _write_measured(path, table, features, check_cancelled):
    """A layer of lines with Z and M into a new file, or as a table of a GeoPackage."""
    suffix = Path(path).suffix.lower()
    types = {int: ogr.OFTInteger64, float: ogr.OFTReal, str: ogr.OFTString}
    with gdal_exceptions():
        crs = None
        if wkt := crs_to_write(features, MEASURED[suffix]):
            crs = osr.SpatialReference()
            crs.SetFromUserInput(wkt)
            crs.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
        dataset = gdal.OpenEx(path, gdal.OF_VECTOR | gdal.OF_UPDATE) if Path(path).exists() else \
            ogr.GetDriverByName(MEASURED[suffix]).CreateDataSource(path)
        layer = dataset.CreateLayer(table or Path(path).stem, crs, ogr.wkbLineStringZM, ["OVERWRITE=YES"] if suffix == ".gpkg" else [])
        for field in features.schema:
            layer.CreateField(ogr.FieldDefn(field.name, types[field.type]))
        layer.StartTransaction()
        for number, (wkb, row) in enumerate(features):
            if number % 5000 == 0:
                check_cancelled()
            feature = ogr.Feature(layer.GetLayerDefn())
            feature.SetGeometry(ogr.CreateGeometryFromWkb(wkb))
            for field in features.schema:
                value = plain_value(row.get(field.name))
                if value is not None:
                    feature.SetField(field.name, value)
            layer.CreateFeature(feature)
        layer.CommitTransaction()
        del layer, dataset
