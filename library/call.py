"""One run of an algorithm on files, without QGIS."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from ..algorithms import parameters as specs
from ..algorithms.call import Call
from ..algorithms.destinations import destination_path, files_of
from ..algorithms.provenance import provenance_now
from ..core.common.errors import RoadExtractionError
from .gdal_module import check_gdal
from .layer_files import DRIVERS, LayerFile, file_and_table, first_table, write_layer
from .measured_lines import check_format
from .values import checked_values

RASTERS = (specs.RasterSpec, specs.RasterOutput)


class FileCall(Call):
    """`Call` for values that name files."""

    VECTOR_SUFFIXES = tuple(DRIVERS)

    def __init__(self, algorithm, given, progress):
        values = checked_values(algorithm, given)
        rasters = [spec for spec in algorithm.parameters if isinstance(spec, RASTERS) and spec.name in values]
        if rasters or algorithm.NEEDS_GDAL:
            check_gdal(f"{rasters[0].label} ({rasters[0].name}) is a raster" if rasters else f"{algorithm.title()} makes a raster")
        for spec in algorithm.parameters:
            if isinstance(spec, specs.LayerOutput) and spec.geometry.endswith("ZM") and spec.name in values:
                check_format(file_and_table(values[spec.name])[0], spec.label)
        super().__init__(algorithm, values)
        self._progress = progress
        self._folders = {}  # of every vector file that is written: destination -> the temporary folder that it is written in

    def _value(self, name):
        return self.parameters.get(name, self.algorithm.parameter(name).default)

    # -- in ---------------------------------------------------------------------------------

    def files(self, name):
        return self._value(name) or []

    def file(self, name):
        return self._value(name) or ""

    number = whole = flag = choice = _value

    def string(self, name):
        return self._value(name) or ""

    def crs(self, name="CRS"):
        from ..core.io.crs import parse_crs
        from ..core.io.units import in_metres

        given = self._value(name)
        try:
            return in_metres(parse_crs(given).to_wkt())[0] if given else ""
        except RoadExtractionError as problem:
            raise RoadExtractionError(f"{self.label(name)}: the CRS {given} is not known. Give it as EPSG:number.") from problem

    def raster(self, name):
        return existing_raster(self._value(name), self.label(name))

    def source(self, name):
        value = self._value(name)
        return LayerFile(value, self.label(name)) if value else None

    def painted(self, name):
        value, label = self._value(name), self.label(name)
        path, table = file_and_table(value)
        if table or Path(path).suffix.lower().lstrip(".") in DRIVERS:
            return LayerFile(value, label), "", ""
        existing_raster(path, label)
        check_gdal(f"{label} ({name}) is a raster")
        from osgeo import gdal

        dataset = gdal.OpenEx(path, gdal.OF_RASTER)
        if dataset is None:  # a vector format of another ending
            return LayerFile(value, label), "", ""
        return None, path, dataset.GetProjection()

    def rows_where(self, name, source):
        condition = self.string(name)
        return source.rows_where(condition) if condition else None

    def layer_name(self, name):
        path, table = file_and_table(self._value(name))
        return table or Path(path).stem

    # -- out --------------------------------------------------------------------------------

    def destination(self, name):
        return self.parameters.get(name, "")

    def output_path(self, name):
        return self.parameters[name]

    def read_as(self, value, path):
        if not path.exists():
            return ""
        _, table = file_and_table(value)
        for spec in self.algorithm.inputs():
            given = self.parameters.get(spec.name)
            for one in given if isinstance(given, list) else [given]:
                if not isinstance(one, str):
                    continue
                source, read = file_and_table(one)
                if Path(source).is_file() and os.path.samefile(path, source) and (not table or table == (read or first_table(source))):
                    return spec.label
        return ""

    def finish(self, numbers):
        """Write the layers beside their destinations, then give all results their names."""
        provenance = provenance_now(self.algorithm.ID, self.values())
        for name, features in self._layers:
            features.description = provenance.sentence(self.algorithm.LOOKS.get(name, name))
            value = self.destination(name)
            path, table = destination_path(value).absolute(), file_and_table(value)[1]
            write_layer(str(self._unfinished(path, table)), table, features, self._progress.check_cancelled)
            self._results[name] = f"{destination_path(value)}|layername={table}" if table else value
        self._progress.check_cancelled()
        self.commit_files()
        for path, folder in self._folders.items():
            replaced = set(files_of(path))
            for file in sorted(Path(folder.name).iterdir()):
                os.replace(file, path.parent / file.name)
                replaced.discard(path.parent / file.name)
            for file in replaced:  # the index or journal of a file that is gone
                file.unlink(missing_ok=True)
        return {**self._results, **numbers}

    def values(self):
        return {spec.name: self._value(spec.name) for spec in self.algorithm.inputs()}

    def _unfinished(self, path, table):
        """Where a vector file is written at first: under its own name in a folder beside it, with the other tables where it has some."""
        if path not in self._folders:
            folder = tempfile.TemporaryDirectory(prefix=f".{path.stem}-", dir=path.parent)
            self._folders[path] = folder
            if table and path.exists():
                shutil.copy2(path, folder.name)
        return Path(self._folders[path].name) / path.name

    def in_users_names(self, text):
        for path, folder in self._folders.items():
            text = text.replace(str(Path(folder.name) / path.name), str(path))
        return super().in_users_names(text)

    def discard_unfinished(self):
        for folder in self._folders.values():
            folder.cleanup()
        super().discard_unfinished()


def existing_raster(path, label):
    if not Path(path).is_file():
        raise RoadExtractionError(f"{label}: there is no file {path}. Check the name and the folder.")
    return path
