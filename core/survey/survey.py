"""An open survey: its points by section of road, the road frame, and what is known of all of them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np

from ..common.progress import Progress
from ..common.setting import Limited, choice, setting
from ..execution.phase import THREADS, Executor, Phase, Recipe, digest, read_plain, write_plain
from .adjustment.register import PassCorrections
from .estimation.adjustment import ScannerSplitter
from .frame.road_frame import RoadFrame
from .las.point_fields import INTENSITY_SOURCES, numbers_by_value
from .las.reader import CloudHeader
from .store.array_file import close_files
from .store.columns import Columns
from .store.records import COORDINATE_SCALE, Points, road_of
from .store.section_store import SectionStore, StoreIndex, Stretch, opened_store
from .weights import FRAME, LAS, READING, STORE

SHIPPED = ("frame", "crs", "sensor_height", "scanner_field", "scanners", "has_intensity", "has_time", "counts", "moves", "above_road",
           "of_colours")


@dataclass(frozen=True)
class SurveySettings(Limited):
    """Settings of reading a survey.

    trajectory_sigma : m, one sigma across of the trajectory, and so of all points, as its processing or check points tell; 0 where unknown
    above_road : m above the road up to which points are kept; the map needs what hides a curb, an inventory what hangs over the road
    """

    corridor: float = setting(FRAME.corridor, 5.0, 100.0, "The corridor", "m")   # m either side of the reference line of a road
    scanner_field: str = choice("automatic", ("automatic", "scanner_channel", "point_source_id"), "The scanner field")
    time: str = choice("automatic", ("automatic", "gps", "adjusted", "week", "day"), "The time system of the trajectory")
    crs: str = ""   # WKT for clouds that carry none
    intensity_from: str = choice(INTENSITY_SOURCES[0], INTENSITY_SOURCES, "The source of the intensity")   # "rgb": the luminance of the colours
    fit_passes: bool = True   # whether passes over one road are adjusted to each other
    trajectory_sigma: float = setting(0.0, 0.0, 10.0, "The accuracy of the trajectory", "m")
    above_road: float = setting(READING.kept_above_road, 1.0, 100.0, "The height above the road", "m")
    section_length: float | None = None   # m of station in a section of the store; None for as many as hold some hundred thousand points
    block: int = LAS.points_per_block   # points decoded at a time


@dataclass
class Survey:
    """An open survey: points by section, the road frame and statistics of the whole survey."""

    files: list[CloudHeader]   # headers of the point clouds
    frame: RoadFrame
    store: SectionStore   # SectionStore of the points
    crs: str   # WKT, "" where unknown
    sensor_height: dict[int, float]   # {pass number: metres from the trajectory down to the road}
    scanner_field: str | None   # LAS field that identifies the scanners, None if there is one
    scanners: list[Any]   # values of that field, see `ScannerCensus.choose`
    has_intensity: bool   # whether intensities differ
    has_time: bool   # whether points are assigned to passes by their time
    counts: dict[str, int] = field(default_factory=dict)   # numbers of points read, kept and outside
    moves: PassCorrections | None = None   # PassCorrections by which points and tracks were moved, None where they are as measured
    above_road: float = READING.kept_above_road   # metres above the road up to which points are returned
    executor: Executor = THREADS   # Executor of the phases that read from this survey
    file: Path | None = None   # by which other processes open it, None where the points are this one's alone
    splitter: ScannerSplitter | None = None   # distinguishes scanners that no field distinguishes; None where there is no need
    of_colours: bool = False   # whether intensities are the brightness of colours

    def __post_init__(self) -> None:
        self.store.finish = lambda road, records: self.finishing(road, records)

    def recipe(self, folder: Path) -> Recipe:
        """Move the points to a folder, unless they are there, and say how other processes open the survey."""
        if self.file is None:
            if self.store.folder is None:
                self.put_in_order(folder)
            file = folder / f"survey-{uuid4().hex}.plain"
            write_plain(file, (self.contents(), []))
            self.file = file
        return Recipe("core.survey.survey:survey_in_file", dict(file=str(self.file)))

    def contents(self) -> dict[str, Any]:
        """What other processes need to open the survey, whose points were put in order in a folder; plain values."""
        return dict(store=self.store.contents(), **{name: getattr(self, name) for name in SHIPPED})

    def along(self, span: Callable[[Any], tuple[int, float, float]], known: Any = None, in_memory: bool = False,
              reach: float = 0.0) -> dict[str, Any]:
        """`place` and `state` of a phase whose items read points near a `span` of road: its number, and stations (m).

        known : plain values that results depend on beside points and arguments
        in_memory : whether results are kept there, too, where points do not change
        reach : m that points are read beyond STORE.read_beyond on either side of a span
        """
        beyond, length, of = STORE.read_beyond + reach, self.store.section_length, digest(known)

        def state(item):
            road, start, end = span(item)
            return of, self.store.state((road, int(np.floor((start - beyond) / length)), int(np.ceil((end + beyond) / length))))

        of_memory = (lambda item: None) if in_memory else None
        return dict(place=lambda item: self.stretch(*span(item)), state=of_memory if self.store.folder is None else state)

    def put_in_order(self, folder: Path | None, executor: Executor = THREADS, progress: Progress = Progress(), moves: Any = None) -> None:
        """Put the points in order, in a folder that the executor's workers see, as they see that of the store; `moves` : as of _UnorderedPoints."""
        source = _UnorderedPoints(self.store, None if self.store.finish is None else self.finishing, folder, moves)
        length, items = self.store.section_length, self.store.stretches(self.store.numbers())
        finished = digest((source.finishing, moves))
        phase = Phase(_order_sections, source, (), lambda item: self.stretch(item[0], item[1] * length, item[2] * length),
                      state=lambda item: (finished, source.store.state((item[0], item[1] - source.beyond, item[2] + source.beyond))))
        roads = [None, *(road for road, *_ in items), None]
        items = [(road, first - source.beyond * (before != road), end + source.beyond * (after != road))
                 for (road, first, end), before, after in zip(items, roads, roads[2:])]
        before = self.store.paths()
        self.store.take_over(StoreIndex.join(list(executor.run(phase, items, progress))), folder)
        close_files()
        for file in before if executor.work is None else ():
            with suppress(OSError):   # Windows removes none that a worker still holds open; it goes with the folder
                file.unlink()

    def stretch(self, road: int, start: float, end: float) -> str:
        """What messages call the road between two stations (m), with the files whose points may lie there."""
        s = np.linspace(start, end, 5)
        x, y = self.frame.to_map(road_of(road), s, 0.0)
        near = [Path(file.path).name for file in self.files if file.count
                and file.minimum[0] - FRAME.corridor <= x.max() and x.min() <= file.maximum[0] + FRAME.corridor
                and file.minimum[1] - FRAME.corridor <= y.max() and y.min() <= file.maximum[1] + FRAME.corridor]
        return f"road {road_of(road)}, {start:.0f} to {end:.0f} m" + (f" ({', '.join(near)})" if near else "")

    def window(self, road: int, start: float, end: float) -> Points:
        """Points of a road with start <= station < end (m) near its height, scanners numbered from 0."""
        return self.store.window(road, start, end)

    def section(self, road: int, number: int) -> Points:
        """Points of one section near the height of the road."""
        return Points(self.store.section(road, number))

    @property
    def finishing(self) -> _Finishing:
        """What the points of a section are finished with before they are put in order."""
        return _Finishing(self.frame, self.sensor_height, self.scanner_field, self.scanners, self.splitter, self.above_road)

    def road_height(self, road: int, s: np.ndarray) -> np.ndarray:
        """(N,) local z of the road under the track at (N,) stations, accurate to decimetres."""
        return self.frame.track_height(road, s, self.sensor_height)


def survey_in_file(file: str) -> Survey:
    """The survey of `Survey.contents` in a file, without the files that it was read from."""
    path = Path(file)
    fields, _ = read_plain(path)
    return Survey(files=[], store=opened_store(path.parent, **fields.pop("store")), file=path, **fields)


# The phase that puts points in order: sections are read from where they were stored, finished, sorted, and written to a folder.

class _UnorderedPoints:
    """Points of a store, which workers must see, to be put in order in a folder, finished with `finishing`, None where they are.

    moves : `moved` gives Columns of moved points, and `reach` by how many m of station at most; None where points stay
    beyond : sections into which points may move
    """

    def __init__(self, store: SectionStore, finishing: _Finishing | None, folder: str | Path | None, moves: Any = None):
        self.store, self.finishing, self.folder, self.moves = store, finishing, None if folder is None else Path(folder), moves
        self.beyond = 0 if moves is None else int(np.ceil(moves.reach / store.section_length))
        store.finish = finishing

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the points."""
        return Recipe("core.survey.survey:_UnorderedPoints", dict(
            store=self.store.recipe(folder), finishing=self.finishing, folder=str(self.folder), moves=self.moves))

    def moved_to(self, stretch: Stretch) -> SectionStore:
        """A store of the points that may lie in a stretch once they are moved."""
        (road, first, end), store = stretch, SectionStore(self.store.dtype, self.store.section_length)
        ends = (np.array([first, end]) * store.section_length + [-self.moves.reach, self.moves.reach]) / COORDINATE_SCALE
        for section in range(first - self.beyond, end + self.beyond):
            records = self.store.section(road, section)
            store.append(road, self.moves.moved(records[slice(*np.searchsorted(records["s"], ends).tolist())]))
        return store


def _order_sections(source: _UnorderedPoints, item: Stretch) -> StoreIndex:
    """The phase: the points of some sections, in order, in a file of the folder."""
    try:
        store = source.store if source.moves is None else source.moved_to(item)
        with SectionStore(store.dtype, store.section_length, source.folder).part() as part:
            return store.written_in_order(store.in_stretch(item), part)
    finally:
        # they are removed when all is in order, which Windows refuses for files that are open
        close_files()


# What is done with the points of a section before they are put in order: scanners are numbered, and those far above or below the road go.


@dataclass(frozen=True)
class _Finishing:
    """Finishes the points of sections: numbers their scanners from 0, and tells those near the height of the road.

    scanner_field, scanners : LAS field that identifies the scanners, None if there is one, and its values, see `ScannerCensus.choose`
    """

    frame: RoadFrame
    sensor_height: dict[int, float]   # {pass number: metres from the trajectory down to the road}
    scanner_field: str | None
    scanners: list[Any]
    splitter: ScannerSplitter | None   # distinguishes scanners that no field distinguishes; None where there is no need
    above_road: float   # metres above the road up to which points are kept

    def __call__(self, road: int, records: Columns) -> np.ndarray | None:
        """Number the scanners of (N,) records of a section, N > 0, and tell which lie near the height of the road: (N,) bool, None for all."""
        if self.splitter is not None:
            records["scanner"] = self.splitter.numbers(records["time"], np.stack([records[name] for name in "xyz"], axis=1) * COORDINATE_SCALE)
        elif self.scanner_field is None:
            records["scanner"] = 0
        else:
            numbers = records["source" if self.scanner_field == "point_source_id" else "scanner"]
            records["scanner"] = numbers_by_value(self.scanners, int(numbers.max()) + 1).take(numbers)
        # only records near the limits are compared with the height at their own station
        z = records["z"]
        below, above = (READING.kept_below_road, self.above_road) if road >= 0 else (READING.level_height, READING.level_height)
        # heights of the road at fixed stations, of which `first` is the number of the first
        first, last = (int(np.floor(end * COORDINATE_SCALE / READING.road_height_step)) for end in (records["s"].min(), records["s"].max()))
        nodes = self.frame.track_height(road_of(road), np.arange(first, last + 2) * READING.road_height_step, self.sensor_height)
        doubtful = np.flatnonzero((z < (nodes.max() - below) / COORDINATE_SCALE + 1)
                                  | (z > (nodes.min() + above) / COORDINATE_SCALE - 1))
        node = records["s"][doubtful] * COORDINATE_SCALE / READING.road_height_step - first
        k = node.astype(np.int64)
        h = z[doubtful] * COORDINATE_SCALE - (nodes[k] + (node - k) * (nodes[k + 1] - nodes[k]))
        near = np.ones(len(records), bool)
        near[doubtful] = (h > -below) & (h < above)
        return None if near[doubtful].all() else near
