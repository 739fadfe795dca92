"""One run of an algorithm on files, without QGIS."""

import os
import re
from pathlib import Path

from ..algorithms.call import Call, existing_file
from ..algorithms.destinations import destination_path
from ..algorithms.provenance import provenance_now
from ..core.common.errors import RoadExtractionError
from ..core.io.local_files import gdal_exceptions, open_raster
from .layer_files import DRIVERS, LayerFile, check_format, check_gdal, file_and_table, first_table, write_layer
from .values import checked_values


class FileCall(Call):
    """`Call` for values that name files."""

    VECTOR_SUFFIXES = tuple(DRIVERS)

    def __init__(self, algorithm, given, progress):
        values = checked_values(algorithm, given)
        rasters = [spec for spec in algorithm.parameters if spec.kind == "raster" and spec.name in values]
        if rasters:
            check_gdal(f"{rasters[0].label} ({rasters[0].name}) is a raster")
        for spec in algorithm.parameters:
            if spec.is_output and spec.geometry.endswith("ZM") and spec.name in values:
                check_format(file_and_table(values[spec.name])[0], spec.label)
        super().__init__(algorithm, values)
        self._progress = progress

    # -- in ---------------------------------------------------------------------------------

    def files(self, name):
        return self.value(name) or []

    def file(self, name):
        return self.value(name) or ""

    def value(self, name):
        return self.parameters.get(name, self.algorithm.parameter(name).default)

    def crs(self, name="CRS"):
        from ..core.io.crs import in_metres, parse_crs

        text = self.value(name)
        try:
            return in_metres(parse_crs(text).to_wkt())[0] if text else ""
        except RoadExtractionError as problem:
            raise RoadExtractionError(f"{self.label(name)}: the CRS {text} is not known. Give it as EPSG:number.") from problem

    def connection(self, name):
        return "service='{}'".format(re.sub(r"(['\\])", r"\\\1", self.value(name)))

    def raster(self, name):
        return existing_file(self.value(name), self.label(name))

    def source(self, name):
        value = self.value(name)
        return LayerFile(value, self.label(name)) if value else None

    def painted(self, name):
        value, label = self.value(name), self.label(name)
        path, table = file_and_table(value)
        if table or Path(path).suffix.lower().lstrip(".") in DRIVERS:
            return LayerFile(value, label), "", ""
        existing_file(path, label)
        check_gdal(f"{label} ({name}) is a raster")
        try:
            with gdal_exceptions():
                return None, path, open_raster(path).GetProjection()
        except RoadExtractionError:  # a vector format of another ending
            return LayerFile(value, label), "", ""

    def rows_where(self, name, source):
        condition = self.value(name)
        return source.rows_where(condition) if condition else None

    def layer_name(self, name):
        path, table = file_and_table(self.value(name))
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
            inputs = self.parameters.get(spec.name)
            for name in inputs if isinstance(inputs, list) else [inputs]:
                if not isinstance(name, str):
                    continue
                source, read = file_and_table(name)
                if Path(source).is_file() and os.path.samefile(path, source) and (not table or table == (read or first_table(source))):
                    return spec.label
        return ""

    def finish(self, numbers):
        """Write the layers beside their destinations, then give all results their names."""
        provenance = provenance_now(self.algorithm.ID, self.values(), self.warnings, self.names_only)
        for name, features in self._layers:
            features.description = "\n".join(provenance.history(self.algorithm.LOOKS.get(name, name)))
            value = self.destination(name)
            path, table = destination_path(value), file_and_table(value)[1]
            unfinished = self._unfinished.begin_copy(path) if table else self._unfinished.begin(path)
            write_layer(str(unfinished), table, features, self._progress.check_cancelled)
            self._results[name] = f"{path}|layername={table}" if table else value
        self._progress.check_cancelled()
        self.sign_files()
        self._unfinished.commit()
        return {**self._results, **numbers}

    def values(self):
        return {spec.name: self.value(spec.name) for spec in self.algorithm.inputs()}
