"""One run of an algorithm: the values the user gave, and the results on their way out."""

import tempfile
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingException,
    QgsProcessingOutputLayerDefinition,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterRasterDestination,
)

from ..core.common.errors import RoadExtractionError
from .destinations import ReplacedFiles, UnfinishedFiles, check_suffix, check_writable, destination_path
from .embedded_style import embed_style
from .input_files import close_database, input_files, written_over
from .knobs import settings_class
from .layers import WKB_TYPES, crs_text, keeps_aliases, qgis_fields, read_features, write_features
from .styling import group_of, style_on_load
from .texts import tr
from .trajectory_source import read_trajectory_source, trajectory_path

FILES = (QgsProcessingParameterFileDestination, QgsProcessingParameterRasterDestination)


class Call:
    """Reads parameters into what the core takes, and writes what the core gave."""

    def __init__(self, algorithm, parameters, context, feedback):
        self.algorithm, self.parameters = algorithm, parameters
        self.context, self.feedback = context, feedback
        self._files = UnfinishedFiles()
        self._scratch = tempfile.TemporaryDirectory(prefix="lanewright-")
        self._results = {}
        self._layers = []

    def label(self, name):
        return self.algorithm.parameterDefinition(name).description()

    # -- in ---------------------------------------------------------------------------------

    def point_clouds(self):
        """Paths of the clouds, each proven to be there."""
        paths = self.algorithm.parameterAsFileList(self.parameters, "POINT_CLOUDS", self.context)
        return [existing_file(path, self.label("POINT_CLOUDS")) for path in paths]

    def _surveyed(self):
        """The point clouds whose name the results go by; none where a stage starts from another's result."""
        if self.algorithm.parameterDefinition("POINT_CLOUDS") is None:
            return []
        return self.algorithm.parameterAsFileList(self.parameters, "POINT_CLOUDS", self.context)

    def cloud(self, name):
        """The path of one point cloud; "" where the optional parameter is empty."""
        path = self.algorithm.parameterAsFile(self.parameters, name, self.context)
        return existing_file(path, self.label(name)) if path else ""

    def crs(self, name="CRS"):
        """WKT, or "" where none was chosen; refuses a CRS that QGIS does not know, which it would pass over."""
        crs = self.algorithm.parameterAsCrs(self.parameters, name, self.context)
        given = self.parameters.get(name)
        if isinstance(given, str) and given and not crs.isValid():
            raise RoadExtractionError(
                tr("{label}: the CRS {given} is not known. Give it as EPSG:number.").format(label=self.label(name), given=given)
            )
        return crs_text(crs)

    def trajectory(self, name="TRAJECTORY", crs="", heights_needed=True):
        """The trajectory as the core takes it, from a layer, a table or a file; `crs` overrules what it says."""
        path = trajectory_path(self.parameters.get(name))
        if path is not None:
            from ..core.survey.trajectory.reader import read_trajectory

            return read_trajectory(existing_file(str(path), self.label(name)), crs)
        source = self.source(name)
        return None if source is None else read_trajectory_source(source, self.label(name), crs, heights_needed)

    def raster(self, name):
        """The file of a raster input."""
        given = self.parameters.get(name)
        if isinstance(given, str) and Path(given).is_file():
            return given  # loaded as a layer, QGIS would write statistics beside it
        layer = self.algorithm.parameterAsRasterLayer(self.parameters, name, self.context)
        if layer is None:
            raise QgsProcessingException(self.algorithm.invalidRasterError(self.parameters, name))
        return existing_file(layer.source(), self.label(name))

    def raster_in(self, name, crs):
        """The file of an optional raster input, reprojected by a small VRT where it lies in another CRS; None where it was not given."""
        if not self.parameters.get(name):
            return None
        from osgeo import gdal

        from ..core.io.crs import parse_crs, same_place
        from ..core.io.gdal_errors import gdal_exceptions

        path = self.raster(name)
        with gdal_exceptions():
            own = gdal.Open(path).GetProjection()
        if not own or not crs or same_place(parse_crs(own), parse_crs(crs)):
            return path
        target = self.scratch_file(f"{name.lower()}.vrt")
        with gdal_exceptions():
            gdal.Warp(target, path, format="VRT", dstSRS=crs)
        return target

    def features(self, name, schema, geometry_type):
        """A vector input as Features; None where the optional parameter is empty."""
        source = self.source(name)
        return None if source is None else read_features(source, schema, geometry_type, self.label(name))

    def source(self, name):
        """A vector input as QGIS's feature source; None where the optional parameter is empty."""
        if self.parameters.get(name) in (None, ""):
            return None
        source = self.algorithm.parameterAsSource(self.parameters, name, self.context)
        if source is None:
            raise QgsProcessingException(self.algorithm.invalidSourceError(self.parameters, name))
        return source

    def knob(self, knob):
        return knob.value(self.algorithm, self.parameters, self.context)

    def settings(self, knobs, **more):
        """The core Settings object that these knobs turn; one not in the dialog keeps its default."""
        shown = [k for k in knobs if self.algorithm.parameterDefinition(k.name) is not None]
        return settings_class(knobs[0].settings)(**{k.field: self.knob(k) for k in shown}, **more)

    def number(self, name):
        return self.algorithm.parameterAsDouble(self.parameters, name, self.context)

    def whole(self, name):
        return self.algorithm.parameterAsInt(self.parameters, name, self.context)

    def flag(self, name):
        return self.algorithm.parameterAsBool(self.parameters, name, self.context)

    def choice(self, name):
        return self.algorithm.parameterAsEnumString(self.parameters, name, self.context)

    def wants(self, name):
        """Whether an optional output was asked for."""
        return bool(self._destination(name))

    # -- out --------------------------------------------------------------------------------

    def check_destinations(self):
        """Prove every output writable before the work, so that a read-only disk is told now."""
        taken, inputs = {}, input_files(self.algorithm, self.parameters, self.context)
        for definition in self.algorithm.destinationParameterDefinitions():
            value = self._destination(definition.name())
            path = destination_path(value)
            if path is None:
                continue
            check_suffix(path, definition)
            read = written_over(value, path, inputs)
            if read:
                raise RoadExtractionError(
                    tr("{label} would be written over {path}, which is read as {input}: inputs are never changed. Give it another name.").format(
                        label=definition.description(), path=path, input=read)
                )
            # Layers of one GeoPackage are told apart by the rest of the value
            place = str(path.absolute()) if value == str(path) else value
            if place in taken:
                raise RoadExtractionError(
                    tr("{first} and {second} would both be written to {path}, and one would be lost. Give each a file of its own, "
                       "or name the layers in one GeoPackage: ogr:dbname='map.gpkg' table=\"road_edges\" (geom).").format(
                        first=taken[place], second=definition.description(), path=path)
                )
            taken[place] = definition.description()
            check_writable(path, definition.description())

    def _destination(self, name):
        value = self.parameters.get(name)
        if isinstance(value, QgsProcessingOutputLayerDefinition):
            value = value.sink.valueAsString(self.context.expressionContext())[0]
        elif value is not None and not isinstance(value, str):
            value = str(value)
        return value

    def new_file(self, name):
        """A temporary path for a file or raster output; "" where it is not wanted."""
        definition = self.algorithm.parameterDefinition(name)
        if not self.wants(name):
            return ""
        if isinstance(definition, QgsProcessingParameterRasterDestination):
            path = self.algorithm.parameterAsOutputLayer(self.parameters, name, self.context)
        else:
            path = self.algorithm.parameterAsFileOutput(self.parameters, name, self.context)
        self._results[name] = path
        return self._files.begin(path)

    def scratch_file(self, name):
        """A path in a folder that vanishes with the run."""
        return str(Path(self._scratch.name) / name)

    def drop_file(self, name):
        """Take back a file that `new_file` began: there is nothing to put into it."""
        path = self._results.pop(name, "")
        if path:
            self._files.forget(path)

    def text(self, name, text):
        """Write a text result (a report) where it is wanted."""
        if self.wants(name):
            Path(self.new_file(name)).write_text(text, encoding="utf-8")

    def layer(self, name, features):
        """Remember a vector result; it is written in `finish`, when nothing can fail any more."""
        if self.wants(name):
            self._layers.append((name, features))

    def finish(self, numbers):
        """Write the layers, name the files, and return the dictionary QGIS wants."""
        replaced = ReplacedFiles()
        try:
            for name, features in self._layers:
                close_database(self._destination(name), self.context)
                replaced.set_aside(self._destination(name))
                self._results[name] = self._write(name, features)
        except BaseException:
            replaced.put_back()
            raise
        replaced.forget()
        self._files.commit()
        schemas = {name: features.schema for name, features in self._layers}
        group = group_of(self._surveyed())
        for name, dest in self._results.items():
            look = self.algorithm.LOOKS.get(name, name)
            embed_style(look, dest, self.label(name), schemas.get(name, ()))
            style_on_load(look, dest, self.label(name), self.context, schemas.get(name, ()), group)
        return {**self._results, **numbers}

    def _write(self, name, features):
        fields = qgis_fields(features.schema, with_aliases=keeps_aliases(destination_path(self._destination(name))))
        crs = QgsCoordinateReferenceSystem.fromWkt(features.crs) if features.crs else QgsCoordinateReferenceSystem()
        sink, dest = self.algorithm.parameterAsSink(
            self.parameters, name, self.context, fields, WKB_TYPES[features.geometry_type], crs
        )
        if sink is None:
            raise QgsProcessingException(self.algorithm.invalidSinkError(self.parameters, name))
        write_features(sink, features, fields, self.feedback)
        # The file is complete only once the sink is gone
        del sink
        return dest

    def in_users_names(self, text):
        """A message with the names of unfinished files replaced by those the user gave."""
        return self._files.in_users_names(text)

    def discard_unfinished(self):
        self._files.discard()
        self._scratch.cleanup()


def existing_file(path, label):
    """The path, or one sentence on why it cannot be used."""
    if "://" in path or "|" in path:
        raise RoadExtractionError(
            tr("{label} names {path}, which is not a file. Choose the LAS or LAZ file itself.").format(label=label, path=path)
        )
    if not Path(path).is_file():
        raise RoadExtractionError(
            tr("{label}: there is no file {path}. Check the name and the folder.").format(label=label, path=path)
        )
    return path
