"""An intensity image in a file of tiles that the operating system keeps in memory.

The chain reads the image through this object; the GeoTIFF is written for the user alone.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ..execution.phase import Recipe
from ..io.geotiff import GEOTIFF_TILE, NODATA, IntensityImage, new_geotiff
from ..survey.store.array_file import ArrayPlace, SharedArrays

StoredTile = tuple[int, int, int, int, ArrayPlace]   # of the part of a tile that has data first column and row, height, width, place of its pixels


def stored_tiles(arrays: SharedArrays, tiles: Iterable[tuple[int, int, np.ndarray]]) -> list[StoredTile]:
    """Write what has data of tiles, or parts of them: first column and row of each, and (H, W) float32, NODATA or not finite where there is none."""
    parts = []
    for column, row, values in tiles:
        filled = np.isfinite(values) & (values != np.float32(NODATA))
        rows, columns = np.flatnonzero(filled.any(axis=1)), np.flatnonzero(filled.any(axis=0))
        if len(rows):
            box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
            parts.append((column + int(columns[0]), row + int(rows[0]), np.where(filled[box], values[box], np.float32(np.nan))))
    places = arrays.put([pixels for _, _, pixels in parts])
    return [(column, row, *pixels.shape, place) for (column, row, pixels), place in zip(parts, places)]


class TiledImage(IntensityImage):
    """An intensity image made of tiles that tasks write and that are read in windows.

    Its pixels, and what `sample` returns, are those of the GeoTIFF of the same tiles.
    Tiles are added by one thread; once all are there, several threads may read.

    arrays : where their pixels lie

    pieces, states : {piece of road, or (column, row) of a tile: digest of all that its part of the image depends on}
    """

    def __init__(self, geotransform: tuple[float, ...], width: int, height: int, crs: str, arrays: SharedArrays,
                 tiles: Sequence[StoredTile] = ()):
        super().__init__("", tuple(geotransform), width, height, crs)
        self._tiles: dict[tuple[int, int], StoredTile] = {}
        self.arrays = arrays
        self.add(tiles)
        self.pieces: dict[Any, str] = {}
        self.places = np.empty((0, 8), np.int64)   # of each piece road, number, first and last column and row, least and greatest offset in 0.1 mm
        self.states: dict[tuple[int, int], str] = {}
        self.lost: list[tuple[int, int]] = []   # first pixels of tiles that another image did not take over
        self._written: tuple[Path, list[int]] | None = None   # the GeoTIFF of this image, and its size and time then

    @contextmanager
    def new_file(self, path: str | PathLike, before: TiledImage | None = None) -> Iterator[Any]:
        """A GeoTIFF of `new_geotiff` at a path, to be written on, with the tiles that are here already.

        before : an image that these were taken over from; of its own file, if that is as it was written, only the other tiles change
        """
        shown = self if before is None else before
        alike = all(getattr(shown, name) == getattr(self, name) for name in ("geotransform", "width", "height"))
        like = shown._file_as_written() if alike else None
        with new_geotiff(path, self.width, self.height, self.geotransform, self.crs, like=like) as file:
            for column, row in self.tiles() if like is None else shown.lost:
                values = self.read_pixels(column, row, min(GEOTIFF_TILE, self.width - column), min(GEOTIFF_TILE, self.height - row))
                file.write(column, row, np.where(np.isnan(values), np.float32(NODATA), values), whole=True)
            yield file
        self._written = Path(path), _state_of(path)

    def _file_as_written(self):
        """The GeoTIFF of this image; None where there is none any more."""
        try:
            return self._written[0] if self._written is not None and _state_of(self._written[0]) == self._written[1] else None
        except OSError:
            return None

    def take_over(self, before: TiledImage) -> None:
        """Take the tiles of another image that are the same, with its file; the others are `lost` to that one."""
        if before.geotransform == self.geotransform:
            self.arrays, before.arrays = before.arrays, self.arrays
            before.lost = [(column * GEOTIFF_TILE, row * GEOTIFF_TILE) for column, row in before._tiles
                           if before.states[column, row] != self.states.get((column, row))]
            self._tiles = {tile: stored for tile, stored in before._tiles.items() if before.states[tile] == self.states.get(tile)}
        else:
            before.states = {}
        before.close()

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the image, whose pixels lie in its folder."""
        return Recipe("core.intensity.tiled_image:TiledImage", dict(
            geotransform=[float(number) for number in self.geotransform], width=int(self.width), height=int(self.height), crs=self.crs,
            arrays=self.arrays, tiles=[*self._tiles.values()]))

    def add(self, tiles: Sequence[StoredTile]) -> None:
        """Add tiles that `stored_tiles` wrote to the image's arrays."""
        self._tiles.update({(tile[0] // GEOTIFF_TILE, tile[1] // GEOTIFF_TILE): tile for tile in tiles})

    def _fill(self, values: np.ndarray, column: int, row: int) -> None:
        height, width = values.shape
        for tile_row in range(row // GEOTIFF_TILE, (row + height - 1) // GEOTIFF_TILE + 1):
            for tile_column in range(column // GEOTIFF_TILE, (column + width - 1) // GEOTIFF_TILE + 1):
                if (tile_column, tile_row) in self._tiles:
                    left, top, *shape, place = self._tiles[tile_column, tile_row]
                    c0, c1 = max(left, column), min(left + shape[1], column + width)
                    r0, r1 = max(top, row), min(top + shape[0], row + height)
                    if c0 < c1 and r0 < r1:
                        pixels = self.arrays.get(place, shape)
                        values[r0 - row:r1 - row, c0 - column:c1 - column] = pixels[r0 - top:r1 - top, c0 - left:c1 - left]

    def tiles(self) -> list[tuple[int, int]]:
        """[(column, row)] of the first pixels of all tiles that hold data, row by row."""
        return [(column * GEOTIFF_TILE, row * GEOTIFF_TILE) for column, row in sorted(self._tiles, key=lambda tile: tile[::-1])]

    def write(self, path: str | PathLike) -> None:
        """Write the image to a GeoTIFF."""
        if self._file_as_written() != Path(path):
            with self.new_file(path):
                pass

    def close(self) -> None:
        self._tiles = {}
        self.arrays.close()


def _state_of(path):
    status = os.stat(path)
    return [status.st_size, status.st_mtime_ns]
