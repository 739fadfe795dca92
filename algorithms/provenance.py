"""Where a result comes from: program, version, algorithm, parameters and time, written into the result itself."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.common.errors import RoadExtractionError
from ..core.common.texts import told
from ..core.io.local_files import gdal_exceptions, open_raster
from ..core.lazy import gdal
from .rooms import core, products
from .texts import tr

if TYPE_CHECKING:
    from .algorithm import Algorithm

PROGRAM = "Lanewright"
WARNED = "warning: "
TIME = "%Y-%m-%dT%H:%M:%SZ"
SYSTEM_AT, SOFTWARE_AT, NAME_BYTES = 26, 58, 32  # places of the two names in the header of a LAS file, and their length
UNNAMED = ("", "OTHER", "laspy")                 # what writers put there when they have nothing to say
SECRET = re.compile(r"(password|passwd|pwd|authcfg)\s*=\s*('[^']*'|\"[^\"]*\"|[^\s&;]+)", re.IGNORECASE)
CREDENTIALS = re.compile(r"(://[^/\s:@]+):[^@/\s]+@")
# A folder, where a value begins with a path or names that of a database; texts that only hold a stroke, such as a WKT, are none
FOLDER = re.compile(r"(?P<before>^(?:file://)?|dbname=')(?P<folder>(?:[A-Za-z]:)?(?:[^|'\"<>\[\]\n]|(?<=[\w\\])'(?=\w))*[\\/])(?=[^\\/])")
SENTENCE = re.compile(r"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ): " + PROGRAM + r" (\S+), (\w+)(?: ([A-Z_]+))?, ({.*})", re.DOTALL)


@dataclass(frozen=True)
class Provenance:
    """One run: its algorithm, the program's version, its inputs and settings by name, when it ended (UTC), what it warned of."""

    algorithm: str
    version: str
    values: Mapping[str, Any]
    ended: datetime
    warnings: tuple[str, ...] = ()

    @property
    def program(self) -> str:
        return f"{PROGRAM} {self.version}"

    @property
    def parameters(self) -> str:
        """Inputs and settings as JSON, without passwords."""
        text = json.dumps({name: value for name, value in self.values.items() if value not in (None, "", [])}, ensure_ascii=False, default=str)
        return CREDENTIALS.sub(r"\1:…@", SECRET.sub(lambda match: f"{match[1]}=…", text.replace('\\"', "'")))

    @property
    def time(self) -> str:
        return self.ended.strftime(TIME)

    def sentence(self, output: str = "") -> str:
        """Program, algorithm, time and parameters in one line; of a layer also which result of the algorithm it is, such as ROAD_EDGES."""
        result = f"{self.algorithm} {output}" if output else self.algorithm
        return f"{self.time}: {self.program}, {result}, {self.parameters}"

    def history(self, output: str = "") -> list[str]:
        """The lines that a layer keeps: the sentence, and one for each warning."""
        return [self.sentence(output), *(f"{self.time}: {WARNED}{text}" for text in self.warnings)]

    def warnings_among(self, lines: Iterable[str]) -> list[str]:
        """The warnings of this run among the lines of a layer's history."""
        begin = f"{self.time}: {WARNED}"
        return [line.removeprefix(begin) for line in lines if line.startswith(begin)]

    @classmethod
    def of_sentence(cls, text: str) -> tuple[Provenance, str] | None:
        """The run and the result that `sentence` told of; None where a text is no such sentence."""
        match = SENTENCE.search(text)
        provenance = _read(match[3], match[2], match[5], match[1]) if match else None
        return None if match is None or provenance is None else (provenance, match[4] or "")

    def tags(self) -> dict[str, str]:
        """The same by name, for formats that keep pairs of names and texts."""
        return {"LANEWRIGHT_VERSION": self.version, "LANEWRIGHT_ALGORITHM": self.algorithm, "LANEWRIGHT_PARAMETERS": self.parameters,
                "LANEWRIGHT_TIME": self.time}


def provenance_now(algorithm: str, values: Mapping[str, Any], warnings: Iterable[str] = (), names_only: bool = False) -> Provenance:
    """The provenance of a run that has just ended; with `names_only` it names files without their folders."""
    if names_only:
        folders: set[str] = set()
        values = {name: _without_folders(value, folders) for name, value in values.items()}
        for folder in sorted(folders, key=len, reverse=True):
            warnings = [text.replace(folder, "") for text in warnings]
    return Provenance(algorithm, own_version(), values, datetime.now(timezone.utc), tuple(warnings))


def _without_folders(value, folders):
    """A value of a parameter with the names of files alone; their folders are noted."""
    if isinstance(value, Mapping):
        return {name: _without_folders(item, folders) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_folders(item, folders) for item in value]
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not isinstance(value, str):
        return value
    folders.update(match["folder"] for match in FOLDER.finditer(value))
    return FOLDER.sub(lambda match: match["before"], value)


@lru_cache(maxsize=256)   # every look at the layers of a project reads them all
def _read(algorithm, version, parameters, time):
    """A Provenance of its texts; None where they are cut off or somebody else's."""
    try:
        values, ended = json.loads(parameters), datetime.strptime(time, TIME).replace(tzinfo=timezone.utc)
    except ValueError:
        return None
    return Provenance(algorithm, version, values, ended) if isinstance(values, dict) else None


def signed_by(path: str | os.PathLike[str]) -> Provenance | None:
    """The provenance that `sign_file` wrote into a GeoTIFF; None where a file is none, or not ours."""
    if Path(path).suffix.lower() not in (".tif", ".tiff") or not Path(path).is_file():
        return None
    try:
        with gdal_exceptions():
            tags = open_raster(path).GetMetadata()
    except RoadExtractionError:
        return None
    texts = [tags.get(f"LANEWRIGHT_{name}") for name in ("ALGORITHM", "VERSION", "PARAMETERS", "TIME")]
    return _read(*texts) if all(texts) else None


def own_version() -> str:
    """The version of the checkout or plugin that this file lies in, otherwise of the installed package."""
    described = Path(__file__).resolve().parents[1] / "metadata.txt"
    if described.is_file():
        return next(line.partition("=")[2] for line in described.read_text(encoding="utf-8").splitlines() if line.startswith("version="))
    from importlib.metadata import version

    return version("lanewright")


def sign_file(path: str | os.PathLike[str], provenance: Provenance) -> None:
    """Write the provenance into a GeoTIFF or a LAS or LAZ file that is complete; files of other kinds stay as they are.

    A LAS header has room for two names of 32 letters: the program with its version, and the algorithm where nothing
    else is named as the system that made the points.
    """
    suffix = Path(path).suffix.lower()
    if suffix in (".tif", ".tiff"):
        _sign_raster(path, provenance)
    elif suffix in (".las", ".laz"):
        _sign_cloud(path, provenance)


def _sign_raster(path, provenance):
    with gdal_exceptions():
        raster = gdal.Open(str(path), gdal.GA_Update)
        raster.SetMetadata({**raster.GetMetadata(), "TIFFTAG_SOFTWARE": provenance.program,
                            "TIFFTAG_DATETIME": provenance.ended.strftime("%Y:%m:%d %H:%M:%S"), **provenance.tags()})
        raster = None  # GDAL writes when it lets go


def _sign_cloud(path, provenance):
    with open(path, "r+b") as file:
        if file.read(4) != b"LASF":
            return
        file.seek(SYSTEM_AT)
        system = file.read(NAME_BYTES).rstrip(b"\0").decode("ascii", "replace").strip()
        if system in UNNAMED:
            file.seek(SYSTEM_AT)
            file.write(_las_name(f"{PROGRAM} {provenance.algorithm}"))
        file.seek(SOFTWARE_AT)
        file.write(_las_name(provenance.program))


def _las_name(text):
    return text.encode("ascii", "replace")[:NAME_BYTES].ljust(NAME_BYTES, b"\0")


# What a report says first: survey, files, CRS, time, version and settings of its run.

MOST_FILES = 5     # that are named
SUFFIXES = (".html", ".htm")


def sign_report(path: str, facts: Callable[[], list[tuple[str, str]]]) -> None:
    """Write the facts of a run below the title of an HTML report that is complete; files of other kinds stay as they are."""
    if Path(path).suffix.lower() in SUFFIXES:
        Path(path).write_text(products.report.page.with_facts(Path(path).read_text(encoding="utf-8"), facts()), encoding="utf-8")


def run_facts(algorithm: Algorithm, survey: str, clouds: Sequence[str], crs: str, provenance: Provenance) -> list[tuple[str, str]]:
    """(name, value) of what tells a run on a survey, with these point clouds and results in a CRS, WKT or "", from others.

    Names of files are without their folders, since a report is handed on.
    """
    files = [Path(path).name for path in clouds]
    named = ", ".join(files[:MOST_FILES]) + (tr(" and {count} more", count=len(files) - MOST_FILES) if len(files) > MOST_FILES else "")
    facts = [(tr("Survey"), survey), (tr("Point clouds"), named), *_inputs(algorithm, provenance.values),
             (tr("CRS"), core.io.crs.parse_crs(crs).name if crs else ""),
             (tr("Made"), f"{provenance.ended:%Y-%m-%d %H:%M} UTC, {provenance.program}"), (tr("Settings"), _settings(algorithm, provenance.values)),
             *((tr("Warning"), told(text)) for text in provenance.warnings)]
    return [(name, value) for name, value in facts if value]


def _inputs(algorithm, values):
    """Files and layers that were given, by the name of their parameter."""
    for spec in algorithm.inputs():
        value = values.get(spec.name)
        if spec.name != "POINT_CLOUDS" and not hasattr(spec, "field") and isinstance(value, str) and ("/" in value or "\\" in value):
            yield spec.label, value.replace("\\", "/").rsplit("/", 1)[-1]


def _settings(algorithm, values):
    """What was set otherwise than by default."""
    changed = [f"{spec.label}: {values[spec.name]}" for spec in algorithm.inputs()
               if hasattr(spec, "field") and spec.name in values and values[spec.name] not in (None, "", spec.default)]
    return "; ".join(changed) or tr("as they are by default")
