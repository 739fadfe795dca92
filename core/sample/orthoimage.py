"""The made street as a UAV sees it: asphalt, paint, sidewalks, grass, cars and trees with their shadows.

The image has no place on the map: that is for georeferencing to find. Its
pixels are what the true distortion puts there, with noise and the blur of a lens.
"""

import os
from pathlib import Path

import cv2
import numpy as np

from ..errors import RoadExtractionError
from ..gdal_errors import gdal_exceptions
from ..progress import Progress
from .control_marks import PLATE, plates
from .obstacles import Car, Post
from .scene import LABEL

_TILE = 256        # px of columns that are rendered at a time
_HALO = 3          # px rendered around them for the blur
_BLUR = 0.65       # px
_NOISE = 4.0       # of 255
_SUN = np.array([0.55, 0.35, 0.80])  # towards the sun: east, north, up
_SHADE = 0.52      # of the light is left in the shadow
_RGB = {"road": (112, 112, 114), "worn paint": (150, 150, 147), "paint": (232, 231, 224), "manhole": (72, 70, 68),
        "gutter": (152, 150, 145), "curb face": (120, 118, 112), "curb stone": (172, 168, 160), "sidewalk": (158, 151, 142),
        "shoulder": (146, 132, 108), "verge": (94, 114, 66)}
_COLOURS = np.zeros((len(LABEL), 3))
for _name, _colour in _RGB.items():
    _COLOURS[LABEL[_name]] = _colour
_LACQUERS = np.array([(228, 228, 226), (176, 180, 184), (44, 46, 52), (124, 26, 30), (38, 62, 108), (92, 96, 98)])
_GLASS = np.array([40.0, 46.0, 54.0])
_LEAVES = np.array([62.0, 92.0, 44.0])


class StreetSeen:
    """The colours of the ground and of what stands on it."""

    def __init__(self, scene, camera, seed):
        self.scene, self.camera, self.seed = scene, camera, seed
        self._plates = plates(scene, camera)

    def colours(self, x, y):
        """(N, 3) float colours of local places, seen from straight above."""
        s, d = self.camera.to_road(self.scene, x, y)
        colours = self._ground(s, d)
        self._lay_plates(colours, x, y)
        z = self.scene.height(s, d)
        for obstacle in self.scene.obstacles:
            self._shade(colours, obstacle, x, y, z)
        for number, obstacle in enumerate(self.scene.obstacles):
            self._cover(colours, number, obstacle, x, y)
        return colours

    def _ground(self, s, d):
        scene, texture = self.scene, self.scene.texture
        label = np.empty(len(s), dtype=np.uint8)
        on_road = (d <= scene.left.edge) & (d >= -scene.right.edge)
        road = np.flatnonzero(on_road)
        label[road] = scene.carriageway_labels(s[road], d[road])
        for side in (scene.left, scene.right):
            beyond = np.flatnonzero(side.sign * d > side.edge)
            strip = np.searchsorted(side.borders, side.sign * d[beyond], side="right") - 1
            names = np.array([LABEL[name] for name in side.strips], dtype=np.uint8)
            label[beyond] = names[np.clip(strip, 0, len(names) - 1)]
        colours = _COLOURS[label]
        fine, broad = texture.at(s, d, 0.06), texture.at(s, d, 1.7)
        rough = np.where(label == LABEL["verge"], 0.16, 0.055)
        light = 1.0 + rough * fine + 0.045 * broad
        for start, end, right, left, factor in scene.repairs:
            there = (s >= start) & (s <= end) & (d >= right) & (d <= left) & (label == LABEL["road"])
            light[there] *= 1.0 - 0.35 * (1.0 - factor)
        # Slabs of a metre, with joints between them
        walk = np.flatnonzero(label == LABEL["sidewalk"])
        light[walk[(s[walk] % 1.0) < 0.03]] *= 0.80
        return colours * np.maximum(light, 0.3)[:, None]

    def _lay_plates(self, colours, x, y):
        """Signalised points: plates in black and white quarters, their middle the point."""
        for at_x, at_y, turn in self._plates:
            near = _within(x, y, at_x, at_y, PLATE)
            a = (x[near] - at_x) * np.cos(turn) + (y[near] - at_y) * np.sin(turn)
            b = (y[near] - at_y) * np.cos(turn) - (x[near] - at_x) * np.sin(turn)
            on = np.maximum(np.abs(a), np.abs(b)) < PLATE / 2
            colours[near[on]] = np.where((a * b > 0)[on, None], 236.0, 26.0)

    def _shade(self, colours, obstacle, x, y, z):
        """Darken the ground from which an obstacle hides the sun."""
        top = obstacle.z + obstacle.top if isinstance(obstacle, Car) else obstacle.top
        throw = (top - z.min()) / _SUN[2] * _SUN[:2]
        middle = obstacle.x - throw[0] / 2, obstacle.y - throw[1] / 2
        near = _within(x, y, *middle, obstacle.reach + np.hypot(*throw) / 2)
        if len(near) == 0:
            return
        direction = np.repeat((_SUN / np.linalg.norm(_SUN))[:, None], len(near), axis=1)
        hit, *_ = obstacle.hits(np.stack([x[near], y[near], z[near]]), direction, self._chance(obstacle, x))
        colours[near[np.isfinite(hit)]] *= _SHADE

    def _cover(self, colours, number, obstacle, x, y):
        """Paint what is seen of an obstacle from above."""
        near = _within(x, y, obstacle.x, obstacle.y, obstacle.reach)
        if len(near) == 0:
            return
        if isinstance(obstacle, Post):
            colours[near] = 128.0
            return
        origin = np.stack([x[near], y[near], np.full(len(near), obstacle.z + 30.0)])
        down = np.repeat(np.array([[0.0], [0.0], [-1.0]]), len(near), axis=1)
        hit, cosine, brightness = obstacle.hits(origin, down, self._chance(obstacle, x))
        seen = np.flatnonzero(np.isfinite(hit) & (cosine > 0))
        if isinstance(obstacle, Car):
            lacquer = _LACQUERS[number % len(_LACQUERS)]
            glass = (np.abs(brightness[seen] - 0.12) < 1e-9)[:, None]
            colours[near[seen]] = np.where(glass, _GLASS, lacquer) * (0.45 + 0.55 * cosine[seen])[:, None]
        else:
            colours[near[seen]] = _LEAVES * (0.45 + 0.9 * cosine[seen])[:, None]

    def _chance(self, obstacle, x):
        return np.random.default_rng([self.seed, 6, int(1000 * obstacle.x) & 0xFFFF, len(x) & 0xFFFF])


def _within(x, y, at_x, at_y, reach):
    """Indices of the places within `reach` of one."""
    if x.min() > at_x + reach or x.max() < at_x - reach or y.min() > at_y + reach or y.max() < at_y - reach:
        return np.empty(0, dtype=np.intp)
    return np.flatnonzero((x - at_x) ** 2 + (y - at_y) ** 2 < reach**2)


@gdal_exceptions()
def write_uav_image(survey, path, progress=None):
    """Write the UAV image of a made survey: an RGB TIFF without a place on the map.

    Parameters
    ----------
    survey : SampleSurvey
    path : of the TIFF, which appears when it is complete

    Raises
    ------
    RoadExtractionError
        If the file cannot be written.
    """
    from osgeo import gdal

    progress = progress or Progress()
    camera = survey.camera
    seen = StreetSeen(survey.scene, camera, survey.settings.seed)
    unfinished = Path(path).with_name(Path(path).name + ".unfinished.tif")
    dataset = None
    try:
        dataset = gdal.GetDriverByName("GTiff").Create(str(unfinished), camera.width, camera.height, 3, gdal.GDT_Byte, [
            "TILED=YES", f"BLOCKXSIZE={_TILE}", f"BLOCKYSIZE={_TILE}", "COMPRESS=JPEG", "JPEG_QUALITY=92", "PHOTOMETRIC=YCBCR"])
        for column in range(0, camera.width, _TILE):
            progress.at(column / camera.width)
            width = min(_TILE, camera.width - column)
            for row in range(0, camera.height, 2 * _TILE):
                height = min(2 * _TILE, camera.height - row)
                tile = _render(seen, camera, column, row, width, height)
                dataset.WriteRaster(column, row, width, height, np.ascontiguousarray(tile.transpose(2, 0, 1)).tobytes(),
                                    buf_type=gdal.GDT_Byte)
        dataset.FlushCache()
        dataset = None
        os.replace(unfinished, path)
    except (RuntimeError, OSError) as problem:
        raise RoadExtractionError(f"The UAV image cannot be written to {path} ({problem}). Choose another folder or free its space.") from problem
    finally:
        dataset = None
        unfinished.unlink(missing_ok=True)
    progress.at(1.0)


def _render(seen, camera, column, row, width, height):
    """(height, width, 3) uint8 of one tile."""
    pixel = np.arange(column - _HALO, column + width + _HALO) + 0.5
    line = np.arange(row - _HALO, row + height + _HALO) + 0.5
    across, down = (axis.ravel() for axis in np.meshgrid(pixel, line))
    colours = seen.colours(*camera.to_map(across, down)).reshape(len(line), len(pixel), 3)
    colours = cv2.GaussianBlur(colours, (0, 0), _BLUR)[_HALO:-_HALO, _HALO:-_HALO]
    u = (pixel[_HALO:-_HALO] - camera.width / 2) / camera.half_diagonal
    v = (line[_HALO:-_HALO] - camera.height / 2) / camera.half_diagonal
    fading = 1.0 - 0.14 * (u[None, :] ** 2 + v[:, None] ** 2)
    noise = np.random.default_rng([seen.seed, 5, column, row]).standard_normal(colours.shape, dtype=np.float32)
    return np.clip(np.rint(colours * fading[..., None] + _NOISE * noise), 1, 255).astype(np.uint8)
