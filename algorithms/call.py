"""One run of an algorithm: the values the user gave, and the results on their way out.

`Call` is what the algorithms see. Each program that runs them (QGIS Processing, the library) derives its own,
which knows how values are given there and how layers are read and written.
"""

import errno
import os
import tempfile
from contextlib import ExitStack, suppress
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from ..core.common.parallel import cancellation_scope, claim_memory, is_lack_of_memory, out_of_memory
from ..core.common.progress import RememberedMessages
from ..core.io.local_files import gdal_exceptions, open_raster
from ..core.lazy import gdal
from .algorithm import MAP_LAYERS, WARNINGS, settings_class
from .destinations import Unfinished, check_folder, check_suffix, check_writable, destination_path
from .provenance import provenance_now, run_facts, sign_file, sign_report
from .rooms import core
from .survey_input import cloud_files, read_trajectory_source, survey_name, trajectory_path
from .texts import tr
from .vector_source import in_file_units, read_features

NAMES_ONLY = "LANEWRIGHT_NAMES_ONLY"


class Call:
    """Reads parameters into what the core takes, and writes what the core gave.

    algorithm : Algorithm
    parameters : dict, parameter name to what was given

    Each program adds these in its own way, most of them by the name of a parameter or result:

    files : the paths given for a parameter of several files
    file : the path given for a file parameter, "" for none; it need not be there
    value : a number, a flag, a word of a choice, or a text as it was given
    crs : WKT, or "" where none was chosen; raises RoadExtractionError where it is not known
    connection : how libpq connects to a database that was chosen; it may hold a password, and nobody is shown it
    raster : the file of a raster input
    source : a vector input as VectorSource; None where the optional parameter is empty
    painted : (VectorSource, "", "") or, of a raster, (None, path, WKT of its CRS)
    rows_where(name, source) : whether the expression of a parameter holds, for every row of a VectorSource; None where the expression is empty
    layer_name : what the user calls a layer that was given
    destination : where a result is to be written, as text; "" where it is not wanted
    output_path : the file that a wanted file or raster result goes to
    read_as(value, path) : the label of the input whose file or table a destination would replace, or ""
    values() : what the user gave or left at its default for every input, in types that JSON has
    finish(numbers) : write the layers, give files their names, and return all results by name
    """

    VECTOR_SUFFIXES = ()  # endings of the vector formats that can be written

    def __init__(self, algorithm, parameters):
        self.algorithm, self.parameters = algorithm, parameters
        self._unfinished = Unfinished()
        self._made_folders = []
        self._scratch = tempfile.TemporaryDirectory(prefix="lanewright-")
        self._results = {}
        self._layers = []
        self._at_end = ExitStack()
        self.warnings = []  # of the run, in the order of the log

    def label(self, name):
        return self.algorithm.parameter(name).label

    @property
    def names_only(self):
        """Whether results name the files that they were made from without their folders; the user says so by a variable."""
        return os.environ.get(NAMES_ONLY, "") not in ("", "0")

    # -- in ---------------------------------------------------------------------------------

    def given(self, name):
        return self.parameters.get(name) not in (None, "", [])

    def point_clouds(self):
        """Paths of the clouds, each proven to be there; of folders and wildcards the files they hold."""
        return [existing_file(path, self.label("POINT_CLOUDS")) for path in self.surveyed()]

    def surveyed(self):
        """The point clouds whose name the results go by; none where a stage starts from another's result."""
        declared = self.algorithm.parameter("POINT_CLOUDS")
        return [] if declared is None else cloud_files(self.files("POINT_CLOUDS"), declared.label)

    @property
    def survey(self):
        """What the survey is called; "" where there is none, or what was given names none."""
        try:
            return survey_name(self.surveyed())
        except RoadExtractionError:
            return ""

    def cloud(self, name):
        """The path of one point cloud; "" where the optional parameter is empty."""
        paths = cloud_files([self.file(name)], self.label(name))
        if len(paths) > 1:
            raise RoadExtractionError(tr("{label}: {path} names {count} point clouds, and one is needed. Choose one of them.", label=self.label(name),
                                         path=self.file(name), count=len(paths)))
        return existing_file(paths[0], self.label(name)) if paths else ""

    def trajectory(self, name="TRAJECTORY", crs="", heights_needed=True, columns=""):
        """The trajectory as the core takes it, from a layer, a table or a file; `crs` and the `columns` of a file overrule what it says."""
        path = trajectory_path(self.parameters.get(name))
        if path is not None:
            return core.survey.trajectory.reader.read_trajectory(existing_file(str(path), self.label(name)), crs, columns=columns)
        if columns.strip():
            raise RoadExtractionError(tr("Columns are those of a text file; {label} is a layer, whose fields have names. Leave Columns empty, or "
                                         "choose the file.", label=self.label(name)))
        source = self.source(name)
        return None if source is None else read_trajectory_source(source, crs, heights_needed)

    def raster_in(self, name, crs):
        """The file of an optional raster input, reprojected by a small VRT where it lies in another CRS; None where it was not given."""
        if not self.parameters.get(name):
            return None

        path = self.raster(name)
        with gdal_exceptions():
            wkt = core.io.crs.place_of_raster(open_raster(path))[1]
        if not wkt or not crs or core.io.crs.same_crs(core.io.crs.parse_crs(wkt), core.io.crs.parse_crs(crs)):
            return path
        target = self.scratch_file(f"{name.lower()}.vrt")
        with gdal_exceptions():
            gdal.Warp(target, path, format="VRT", dstSRS=crs)
        return target

    def features(self, name, schema, geometry_type):
        """A vector input as Features; None where the optional parameter is empty."""
        source = self.source(name)
        return None if source is None else read_features(source, schema, geometry_type)

    def map_layer(self, name):
        """An input that is a layer of the road map, as Features; None where it is optional and empty, or the algorithm has none."""
        given = self.algorithm.parameter(name) is not None
        return self.features(name, MAP_LAYERS[name].schema, MAP_LAYERS[name].geometry) if given else None

    def settings(self, specs, **more):
        """The core Settings object that these specs describe; one that the algorithm does not offer keeps its default."""
        offered = [spec for spec in specs if self.algorithm.parameter(spec.name) is not None]
        return settings_class(specs[0].settings)(**{spec.field: self.value(spec.name) for spec in offered}, **more)

    def wants(self, name):
        return bool(self.destination(name))

    # -- out --------------------------------------------------------------------------------

    def print_sheets(self, settings, progress):
        """Draw sheets along the road into OUTPUT; returns the numbers."""
        raise RoadExtractionError(tr("Sheets are drawn by QGIS. Run Sheets along the road there, or qgis_process run lanewright:printsheets."))

    def check_destinations(self):
        """Prove every output writable before the work, so that a read-only disk is reported now."""
        label_by_target = {}
        for spec in self.algorithm.outputs():
            value = self.destination(spec.name)
            path = destination_path(value)
            if path is None:
                continue
            if spec.kind == "folder":
                check_folder(path, spec.label)
                other = label_by_target.setdefault(os.path.realpath(path), spec.label)
                if other != spec.label:
                    raise RoadExtractionError(tr("{first} and {second} would both be written to {path}, and one would be lost. Give each a folder of "
                                                 "its own.", first=other, second=spec.label, path=path))
                continue
            check_suffix(path, spec, self.VECTOR_SUFFIXES)
            read = self.read_as(value, path) or self._cloud_at(path)
            if read:
                raise RoadExtractionError(tr("{label} would be written over {path}, which is read as {input}: inputs are never changed. Give it "
                                             "another name.", label=spec.label, path=path, input=read))
            # layers of one GeoPackage differ in the rest of the value
            target = str(path.absolute()) if value == str(path) else value
            if target in label_by_target:
                raise RoadExtractionError(tr("{first} and {second} would both be written to {path}, and one would be lost. Give each its own file, "
                                             "or a table of one GeoPackage: ogr:dbname='map.gpkg' table=\"road_edges\" (geom).",
                                             first=label_by_target[target], second=spec.label, path=path))
            label_by_target[target] = spec.label
            check_writable(path, spec.label)

    def _cloud_at(self, path):
        """The label of the point clouds where one of them, maybe by the name of its folder alone, is at a path; otherwise ""."""
        is_cloud = path.exists() and any(Path(cloud).is_file() and os.path.samefile(cloud, path) for cloud in self.surveyed())
        return self.label("POINT_CLOUDS") if is_cloud else ""

    def new_file(self, name):
        """A temporary path for a file or raster output; "" where it is not wanted."""
        if not self.wants(name):
            return ""
        self._results[name] = path = self.output_path(name)
        return str(self._unfinished.begin(path))

    def new_file_in(self, name, file_name):
        """A temporary path for a file of that name in a result that is a folder, which is made; "" where it is not wanted."""
        if not self.wants(name):
            return ""
        folder = Path(self.output_path(name))
        if not folder.exists():
            folder.mkdir()
            self._made_folders.append(folder)
        if read := self._cloud_at(folder / file_name):
            raise RoadExtractionError(tr("{label} would be written over {path}, which is read as {input}: inputs are never changed. Choose another "
                                         "folder.", label=self.label(name), path=folder / file_name, input=read))
        self._results[name] = str(folder)
        return str(self._unfinished.begin(folder / file_name))

    def scratch_file(self, name):
        """A path in a folder that vanishes with the run."""
        return str(Path(self._scratch.name) / name)

    def drop_file(self, name):
        """Take back a file that `new_file` began: there is nothing to put into it."""
        path = self._results.pop(name, "")
        if path:
            self._unfinished.forget(path)

    def text(self, name, text):
        """Write a text result (a report) where it is wanted."""
        if self.wants(name):
            Path(self.new_file(name)).write_text(text, encoding="utf-8")

    def layer(self, name, features):
        """Remember a vector result; it is written in `finish`, when nothing can fail any more."""
        if self.wants(name):
            self._layers.append((name, in_file_units(features)))

    @property
    def layers(self):
        """[(name, Features)] of the vector results so far."""
        return self._layers

    def sign_files(self):
        """Note in every file where it comes from; that note, for the layers."""
        provenance = provenance_now(self.algorithm.ID, self.values(), self.warnings, self.names_only)
        crs = next((features.crs for _, features in self._layers if features.crs), "")
        for path in self._unfinished.begun():
            sign_file(path, provenance)
            sign_report(path, lambda: run_facts(self.algorithm, self.survey, self.surveyed(), crs, provenance))
        return provenance

    def in_users_names(self, text):
        """A message with the names of unfinished files replaced by those the user gave."""
        return self._unfinished.in_users_names(text)

    def at_end(self, action):
        """Call a function when the run ends, however it does."""
        self._at_end.callback(action)

    def discard_unfinished(self):
        self._at_end.close()
        self._unfinished.discard()
        for folder in self._made_folders:
            with suppress(OSError):   # what a run has finished lies in it
                folder.rmdir()
        self._scratch.cleanup()


def run(call, progress):
    """Run the algorithm of a call; its results by name.

    Raises RoadExtractionError if there are none, in one sentence on why. Cancelled if the user stopped it.
    """
    listener = RememberedMessages(progress)
    try:
        claim_memory()
        call.check_destinations()
        for name in filter(call.given, call.algorithm.RETIRED):
            listener.warn(tr("{name} was given and has no effect any more: the usual value is used. Leave it out.", name=name))
        with cancellation_scope(progress):
            results = call.algorithm.work(call, listener) or {}
        call.warnings = listener.warnings
        results[WARNINGS] = len(call.warnings)
        return call.finish(results)
    except Exception as error:
        reason = _reason(error)
        if not reason:
            raise
        raise RoadExtractionError(call.in_users_names(reason)) from error
    finally:
        call.discard_unfinished()


def _reason(error):
    """What ended a run, in one sentence where it lies outside of the program; otherwise ""."""
    if isinstance(error, RoadExtractionError):
        return str(error)
    if is_lack_of_memory(error):
        return out_of_memory()
    if isinstance(error, OSError) and error.strerror is not None:
        full = tr("Free some space there; the variable TMPDIR (Windows: TEMP) names the folder for temporary files.")
        return f"{error.strerror}: {error.filename or tr('while writing')}." + f" {full}" * (error.errno == errno.ENOSPC)
    return ""


def existing_file(path, label):
    """The path, or one sentence on why it cannot be used."""
    if "://" in path or "|" in path:
        raise RoadExtractionError(tr("{label} names {path}, which is not a file. Choose the LAS or LAZ file itself.", label=label, path=path))
    if not Path(path).is_file():
        raise RoadExtractionError(tr("{label}: there is no file {path}. Check the name and the folder.", label=label, path=path))
    return path


def time_left(seconds):
    """How long a run will still take, as the user reads it, in the unit that gives a small number."""
    if seconds < 60:
        return tr("About {number} s left", number=round(seconds))
    if seconds < 3600:
        return tr("About {number} min left", number=round(seconds / 60))
    return tr("About {number} h left", number=round(seconds / 3600))
