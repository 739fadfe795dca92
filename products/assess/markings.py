"""Markings against a reference, cell by cell and object by object."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely

from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.common.setting import check_limits, setting
from ...core.io.crs import NO_PLACE, place_of_raster
from ...core.io.geotiff import new_geotiff
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.lazy import cv2, gdal, ogr
from .matching import Rates

HIT, MISSED, FALSE, MISSED_BESIDE, FALSE_BESIDE = 1, 2, 3, 4, 5  # values of the outcome raster
CHART_BLOCK = 16  # cells, side of the blocks summed up for the chart along the road
WriteTile = Callable[[tuple[int, int], np.ndarray], None]
Burn = Callable[[tuple[float, float, float, float], tuple[int, int]], np.ndarray]


@dataclass(frozen=True)
class MarkingAccuracySettings:
    cell_size: float = setting(0.04, 0.005, 1.0, "The cell size", "m")
    tolerances: tuple[int, ...] = (0, 1)  # cells by which the other side is widened
    tolerance: int = setting(1, 0, 10, "The tolerance", "cells")  # the one that objects are judged and drawn with
    found_share: float = setting(0.5, 0.01, 1.0, "The share that makes an object found")  # share of an object's cells that makes it found, or right
    line_width: float = setting(0.15, 0.01, 10.0, "The width of lines", "m")  # of lines without a width of their own

    def __post_init__(self) -> None:
        check_limits(self)
        tolerances = tuple(sorted({0, self.tolerance, *self.tolerances}))
        if any(t != int(t) or not 0 <= t <= 10 for t in tolerances):
            text = ", ".join(f"{t:g}" for t in tolerances)
            raise RoadExtractionError(f"The tolerances are {text}; give whole numbers of cells from 0 to 10, such as 0, 1.")
        object.__setattr__(self, "tolerances", tuple(int(t) for t in tolerances))


@dataclass(frozen=True)
class _ClassAccuracy:
    """Counts of cells of one class."""

    reference: int   # cells of the reference,
    found: int   # of which the result has paint of any class,
    found_beside: int   # or has some within the tolerance
    result: int   # cells of the result,
    right: int   # of which the reference has paint of any class,
    right_beside: int   # or has some within the tolerance
    same: int   # cells of this class in both

    @property
    def rates(self) -> Rates:
        """Rates of the class itself: a cell of another class is wrong."""
        return Rates(self.same, self.result - self.same, self.reference - self.same)


@dataclass(frozen=True)
class MarkingAccuracy:
    """The accuracy of markings.

    reference_cells, reference_found, result_cells, result_right : (N,) judged cells of every object
    blocks : (N, 5) x, y (metres) and numbers of cells hit, missed and false of every block with any, with the tolerance
    """

    rates: dict[int, Rates]   # tolerance (cells) to Rates in cells
    objects: Rates   # Rates in objects, with the tolerance of the settings
    by_class: dict[str, _ClassAccuracy]   # class to _ClassAccuracy, of all classes in the reference or the result
    reference_cells: np.ndarray = field(repr=False)
    reference_found: np.ndarray = field(repr=False)
    result_cells: np.ndarray = field(repr=False)
    result_right: np.ndarray = field(repr=False)
    blocks: np.ndarray = field(repr=False)
    settings: MarkingAccuracySettings = MarkingAccuracySettings()

    @property
    def strict(self) -> Rates:
        return self.rates[0]

    @property
    def tolerant(self) -> Rates:
        return self.rates[self.settings.tolerance]

    def outcomes(self) -> tuple[np.ndarray, np.ndarray]:
        """("correct" | "missed" | "excluded" of every reference object, "correct" | "false" | "excluded" of every result object)."""
        share = self.settings.found_share
        return (_outcome(self.reference_cells, self.reference_found, share, "missed"),
                _outcome(self.result_cells, self.result_right, share, "false"))


def assess_markings(result: Sequence[Any], reference: Sequence[Any], settings: MarkingAccuracySettings = MarkingAccuracySettings(),
                    result_classes: Sequence[Any] | None = None, reference_classes: Sequence[Any] | None = None, area: Any = None,
                    seen: str | None = None, write_tile: WriteTile | None = None, progress: Progress = Progress()) -> MarkingAccuracy:
    """Assess painted polygons cell by cell and object by object.

    result, reference : lists of shapely polygons in one metric CRS (`inputs` makes them from lines and rasters)
    result_classes, reference_classes : class of every polygon, or None
    area : shapely polygon; what lies outside is not judged, or None
    seen : path of a raster in the same CRS whose empty cells are not judged, or None
    write_tile : called with (column, row) of each tile and its (BURN_TILE, BURN_TILE) uint8 of HIT and so on, or None
    """
    classes = sorted({str(name) for name in (*(result_classes or ()), *(reference_classes or ())) if name is not None})
    counts = _CellCounts(len(result), len(reference), _numbers(result_classes, len(result), classes),
                         _numbers(reference_classes, len(reference), classes), len(classes), settings)
    margin = max(settings.tolerances)
    burners = _rasteriser(result), _rasteriser(reference)
    valid = ([] if area is None else [_rasteriser([area])]) + ([_data_mask(seen)] if seen else [])
    tiles = _covering_tiles([*result, *reference], settings.cell_size, margin)
    shape = (BURN_TILE + 2 * margin,) * 2
    inner = slice(margin, margin + BURN_TILE)
    for number, tile in enumerate(tiles):
        progress.report(number / len(tiles))
        bounds = _tile_bounds(tile, settings.cell_size, margin)
        result_ids, reference_ids = (burn(bounds, shape) for burn in burners)
        judged = np.logical_and.reduce([burn(bounds, shape)[inner, inner] > 0 for burn in valid]) if valid else True
        # and what lies within so many cells, corners included
        widened = {t: [cv2.dilate(np.uint8(ids > 0), np.ones((2 * t + 1,) * 2, np.uint8))[inner, inner] > 0 for ids in (result_ids, reference_ids)]
                   for t in settings.tolerances}
        values = counts.add(result_ids[inner, inner], reference_ids[inner, inner], widened, judged)
        counts.add_blocks(values, tile, settings.cell_size)
        if write_tile is not None and values.any():
            write_tile(tile, values)
    return counts.accuracy(classes, settings)


class _CellCounts:
    """Counts over the tiles."""

    def __init__(self, results, references, result_class, reference_class, classes, settings):
        self.tolerance, self.totals = settings.tolerance, np.zeros(2, np.int64)
        self.cells = {t: np.zeros(2, np.int64) for t in settings.tolerances}  # right of the result, found of the reference
        self.result_class, self.reference_class = result_class, reference_class
        self.result_cells, self.result_right = np.zeros(results + 1, np.int64), np.zeros(results + 1, np.int64)
        self.reference_cells, self.reference_found = np.zeros(references + 1, np.int64), np.zeros(references + 1, np.int64)
        self.by_class = np.zeros((7, classes + 1), np.int64)
        self.blocks = []

    def add(self, result_ids, reference_ids, beside, judged):
        """Count one tile and return its outcomes. `beside`: tolerance to the masks of result and reference widened by it."""
        r, t = np.nonzero((result_ids > 0) & judged), np.nonzero((reference_ids > 0) & judged)
        m, k = result_ids[r], reference_ids[t]
        self.totals += len(m), len(k)
        for tolerance, (near_result, near_reference) in beside.items():
            self.cells[tolerance] += near_reference[r].sum(), near_result[t].sum()
        near_result, near_reference = beside[self.tolerance]
        right, right_beside = reference_ids[r] > 0, near_reference[r]
        detected, detected_beside = result_ids[t] > 0, near_result[t]
        _add(self.result_cells, m), _add(self.result_right, m[right_beside])
        _add(self.reference_cells, k), _add(self.reference_found, k[detected_beside])
        rc, tc = self.result_class[m], self.reference_class[k]
        for row, values in enumerate((tc, tc[detected], tc[detected_beside], rc, rc[right], rc[right_beside],
                                      rc[right][rc[right] == self.reference_class[reference_ids[r][right]]])):
            _add(self.by_class[row], values)
        values = np.zeros(result_ids.shape, np.uint8)
        values[r] = np.where(right, HIT, np.where(right_beside, FALSE_BESIDE, FALSE))
        lost = ~detected
        values[t[0][lost], t[1][lost]] = np.where(detected_beside[lost], MISSED_BESIDE, MISSED)
        return values

    def add_blocks(self, values, tile, cell_size):
        n = BURN_TILE // CHART_BLOCK
        cut = values.reshape(n, CHART_BLOCK, n, CHART_BLOCK)
        hit, missed, false = (sum((cut == value).sum(axis=(1, 3)) for value in group)
                              for group in ((HIT, MISSED_BESIDE, FALSE_BESIDE), (MISSED,), (FALSE,)))
        row, column = np.nonzero(hit + missed + false)
        x0, _, _, y1 = _tile_bounds(tile, cell_size)
        size = CHART_BLOCK * cell_size
        self.blocks.append(np.c_[x0 + (column + 0.5) * size, y1 - (row + 0.5) * size,
                                 hit[row, column], missed[row, column], false[row, column]])

    def accuracy(self, classes, settings):
        result_ids, reference_ids = self.totals.tolist()
        rates = {t: Rates(int(right), result_ids - int(right), reference_ids - int(detected), int(detected))
                 for t, (right, detected) in self.cells.items()}
        by_class = {name: _ClassAccuracy(*self.by_class[:, number].tolist()) for number, name in enumerate(classes, start=1)}
        objects = [self.reference_cells[1:], self.reference_found[1:], self.result_cells[1:], self.result_right[1:]]
        was_found, was_right = (_outcome(objects[k], objects[k + 1], settings.found_share, "wrong") for k in (0, 2))
        counts = [int((outcome == value).sum()) for outcome in (was_right, was_found) for value in ("correct", "wrong")]
        return MarkingAccuracy(
            rates, Rates(counts[0], counts[1], counts[3], counts[2]), by_class, *objects,
            np.concatenate(self.blocks) if self.blocks else np.empty((0, 5)), settings)


def _numbers(names, count, classes):
    """Class number by polygon number; 0 for none."""
    number_of = {name: number for number, name in enumerate(classes, start=1)}
    return np.array([0, *(0 if name is None else number_of[str(name)] for name in names or [None] * count)])


def _add(counts, numbers):
    counts += np.bincount(numbers, minlength=len(counts))


def _outcome(cells, good, share, otherwise):
    outcome = np.where(good >= share * cells, "correct", otherwise)
    return np.where(cells > 0, outcome, "excluded")


# Polygons rasterised in tiles of small cells, on one grid through the map's origin, and the raster of outcomes.

BURN_TILE = 2048  # cells, side of a tile


@gdal_exceptions()
def _rasteriser(polygons: Sequence[Any]) -> Burn:
    """A function of (min x, min y, max x, max y) and (rows, columns) that gives int32 numbers of polygons, from 1 on, 0 elsewhere.

    A cell belongs to a polygon if its centre does, to the later of two that overlap.
    """
    source = ogr.GetDriverByName("Memory").CreateDataSource("polygons")
    layer = source.CreateLayer("polygons", None, ogr.wkbUnknown)
    layer.CreateField(ogr.FieldDefn("number", ogr.OFTInteger))
    for number, wkb in enumerate(shapely.to_wkb(np.asarray(polygons, object), output_dimension=2), start=1):
        feature = ogr.Feature(layer.GetLayerDefn())
        feature.SetField(0, number)
        feature.SetGeometryDirectly(ogr.CreateGeometryFromWkb(wkb))
        layer.CreateFeature(feature)

    @gdal_exceptions()
    def burn(bounds, shape, source=source):   # which holds the layer
        raster = gdal.GetDriverByName("MEM").Create("", shape[1], shape[0], 1, gdal.GDT_Int32)
        size = (bounds[2] - bounds[0]) / shape[1]
        raster.SetGeoTransform((bounds[0], size, 0.0, bounds[3], 0.0, -size))
        layer.SetSpatialFilterRect(*bounds)
        # GDAL warns, tile by tile, that two layers without CRS match
        gdal.PushErrorHandler("CPLQuietErrorHandler")
        try:
            gdal.RasterizeLayer(raster, [1], layer, options=["ATTRIBUTE=number"])
        finally:
            gdal.PopErrorHandler()
        return np.frombuffer(raster.ReadRaster(), np.int32).reshape(shape)

    return burn


@gdal_exceptions()
def _data_mask(path: str) -> Burn:
    """The same of whether a raster has a value at the centre of each cell: where nothing was scanned, nothing can be judged."""
    raster = open_raster(path)
    view = gdal.Translate("", raster, format="VRT", bandList=[1])
    view.SetGeoTransform(place_of_raster(raster)[0] or NO_PLACE)

    @gdal_exceptions()
    def burn(bounds, shape):
        burnt = gdal.Warp("", view, format="MEM", outputBounds=bounds, width=shape[1], height=shape[0], resampleAlg="near",
                          outputType=gdal.GDT_Float64, dstNodata="nan")
        return np.isfinite(np.frombuffer(burnt.ReadRaster(), np.float64)).reshape(shape)

    return burn


def _covering_tiles(polygons: Sequence[Any], cell_size: float, margin: int) -> list[tuple[int, int]]:
    """Sorted (column, row) of the tiles, counted from the map's origin, that polygons widened by `margin` cells touch."""
    side = BURN_TILE * cell_size
    bounds = shapely.bounds(np.asarray(polygons, object)).reshape(-1, 4) + margin * cell_size * np.array([-1, -1, 1, 1])
    return sorted({(column, row) for a, b, c, d in np.floor(bounds / side).astype(int).tolist() for column in range(a, c + 1)
                   for row in range(b, d + 1)})


def _tile_bounds(tile: tuple[int, int], cell_size: float, margin: int = 0) -> tuple[float, float, float, float]:
    """(min x, min y, max x, max y) of a tile with `margin` cells around it."""
    side, border = BURN_TILE * cell_size, margin * cell_size
    return tile[0] * side - border, tile[1] * side - border, (tile[0] + 1) * side + border, (tile[1] + 1) * side + border


@contextmanager
def outcome_raster(path: str, polygons: Iterable[Any], cell_size: float, crs: str, margin: int = 0) -> Iterator[WriteTile]:
    """A GeoTIFF of the outcomes of `assess_markings`: HIT and so on, 0 where neither side is painted; yields what writes a tile of it.

    It covers the polygons of result and reference, widened by `margin` cells of `cell_size` metres. crs : WKT, "" if unknown
    """
    tiles = np.array(_covering_tiles(list(polygons), cell_size, margin) or [(0, 0)])
    (west, south), (east, north) = tiles.min(axis=0).tolist(), tiles.max(axis=0).tolist()
    x0, _, _, y1 = _tile_bounds((west, north), cell_size)
    with new_geotiff(path, (east - west + 1) * BURN_TILE, (north - south + 1) * BURN_TILE, (x0, cell_size, 0.0, y1, 0.0, -cell_size), crs,
                     byte=True, nodata=0, description="1 hit, 2 missed, 3 false, 4 missed beside a hit, 5 false beside paint") as raster:
        yield lambda tile, values: raster.write((tile[0] - west) * BURN_TILE, (north - tile[1]) * BURN_TILE, values)
