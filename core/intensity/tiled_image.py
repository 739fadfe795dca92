"""An intensity image in a file of tiles that the operating system keeps in memory.

The chain reads the image through this object; the GeoTIFF is written for the user alone.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

import numpy as np

from ..execution.phase import Recipe
from ..io.geotiff import GEOTIFF_TILE, NODATA, IntensityImage, new_geotiff
from ..survey.store.array_file import ArrayFile, opened


class _StoredTile(NamedTuple):
    """The part of a tile that has data: its first pixel in the image, its height and width, and the first byte of its values in the file."""

    column: int
    row: int
    height: int
    width: int
    place: int


class TiledImage(IntensityImage):
    """An intensity image made of tiles that are put into it one by one and read in windows.

    Its pixels, and what `sample` returns, are those of the GeoTIFF of the same tiles.
    Tiles are put by one thread; once all are there, several threads may read.

    folder : where the file lies, so that other processes can read it; None for a temporary one without a name

    pieces, states : {piece of road, or (column, row) of a tile: digest of all that its part of the image depends on}
    """

    def __init__(self, geotransform: tuple[float, ...], width: int, height: int, crs: str, folder: Path | None = None):
        super().__init__("", geotransform, width, height, crs)
        self._tiles: dict[tuple[int, int], _StoredTile] = {}
        self.folder = folder
        self._file: ArrayFile | Path | None = None
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
            self._file, before._file = before._file, None
            before.lost = [(column * GEOTIFF_TILE, row * GEOTIFF_TILE) for column, row in before._tiles
                           if before.states[column, row] != self.states.get((column, row))]
            self._tiles = {tile: stored for tile, stored in before._tiles.items() if before.states[tile] == self.states.get(tile)}
        else:
            before.states = {}
            before.close()

    def recipe(self, folder: Path) -> Recipe:
        """How other processes open the image, whose pixels lie in its folder."""
        return Recipe("core.intensity.tiled_image:_shared_image", dict(
            file=str(self._file.path) if isinstance(self._file, ArrayFile) else "", tiles=np.array([*self._tiles.values()], np.int64).reshape(-1, 5),
            geotransform=[float(number) for number in self.geotransform], width=int(self.width), height=int(self.height), crs=self.crs))

    def put(self, column: int, row: int, values: np.ndarray) -> None:
        """Put a tile or the filled part of one, (H, W) float32, NODATA or NaN where there is none; column and row are those of the first pixel."""
        filled = np.isfinite(values) & (values != np.float32(NODATA))
        rows, columns = np.flatnonzero(filled.any(axis=1)), np.flatnonzero(filled.any(axis=0))
        if not len(rows):
            return
        box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        pixels = np.where(filled[box], values[box], np.float32(np.nan))
        if not isinstance(self._file, ArrayFile):
            self._file = ArrayFile(self.folder and self.folder / f"image-{uuid4().hex}.bin")
        self._tiles[column // GEOTIFF_TILE, row // GEOTIFF_TILE] = _StoredTile(
            column + int(columns[0]), row + int(rows[0]), pixels.shape[0], pixels.shape[1], self._file.put([pixels], pixels.nbytes))

    def _fill(self, values: np.ndarray, column: int, row: int) -> None:
        height, width = values.shape
        for tile_row in range(row // GEOTIFF_TILE, (row + height - 1) // GEOTIFF_TILE + 1):
            for tile_column in range(column // GEOTIFF_TILE, (column + width - 1) // GEOTIFF_TILE + 1):
                if (tile_column, tile_row) in self._tiles:
                    self._copy(self._tiles[tile_column, tile_row], column, row, values)

    def _copy(self, tile: _StoredTile, column: int, row: int, values: np.ndarray) -> None:
        """Fill what a tile covers of a window whose first pixel is given."""
        height, width = values.shape
        c0, c1 = max(tile.column, column), min(tile.column + tile.width, column + width)
        r0, r1 = max(tile.row, row), min(tile.row + tile.height, row + height)
        if c0 < c1 and r0 < r1:
            file: Any = opened(self._file) if isinstance(self._file, Path) else self._file
            pixels = file.get(tile.place, tile.height * tile.width, np.float32).reshape(tile.height, tile.width)
            values[r0 - row:r1 - row, c0 - column:c1 - column] = pixels[r0 - tile.row:r1 - tile.row, c0 - tile.column:c1 - tile.column]

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
        if isinstance(self._file, ArrayFile):
            self._file.close()
            if self._file.path is not None:
                self._file.path.unlink(missing_ok=True)
        self._file = None


def _state_of(path):
    status = os.stat(path)
    return [status.st_size, status.st_mtime_ns]


def _shared_image(file: str, tiles: np.ndarray, geotransform: list[float], width: int, height: int, crs: str) -> TiledImage:
    """What `TiledImage.recipe` describes: (T, 5) of each tile first column and row, height, width and first byte."""
    image = TiledImage(tuple(geotransform), width, height, crs)
    image._file = Path(file)
    image._tiles = {(tile.column // GEOTIFF_TILE, tile.row // GEOTIFF_TILE): tile for tile in (_StoredTile(*row) for row in tiles.tolist())}
    return image
