"""The simulated street as a UAV sees it, and its ground control points.

The image shows asphalt, paint, sidewalks, grass, and cars and trees with their shadows. It has no position on the map,
because that is the task of georeferencing, only the tags of a drone that knows about where it hung. Its pixels follow a
known distortion, with noise and the blur of a lens.
Control points are corners of markings, and signalised plates beside the road.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import numpy as np

from ..core.common.errors import RoadExtractionError
from ..core.common.features import CONTROL_POINTS, Features
from ..core.common.progress import Progress
from ..core.io.local_files import gdal_exceptions, unfinished_path
from ..core.lazy import cv2
from .camera import GROUND_PIXEL, Camera
from .camera_tags import camera_tags
from .parts.materials import LABEL
from .parts.obstacles import Crown, Post
from .streets.street import Scene

if TYPE_CHECKING:
    from .survey import SampleSurvey

PLATE_SIDE = 0.6     # m, side of a signalised plate
_PLATE_EVERY = 40.0  # m between plates along each border of the image
_CORNERS = 18        # corners of markings
_CLEAR = 0.4         # m from a corner to an obstacle
_SURVEYED = 0.008    # m, standard deviation of the map coordinates
_POINTED = 0.25      # pixels, standard deviation of the places in the image
_EVERY_CHECK = 3     # every third corner of a marking is a check point; plates, near the borders, never
_TILE = 256          # pixels, side of a tile of the file
_HALO = 3            # pixels rendered around a tile for the blur
_BLUR = 0.65         # pixels, standard deviation
_NOISE = 4.0         # of 255, standard deviation
_SUN = np.array([0.55, 0.35, 0.80])  # direction to the sun: east, north, up
_SHADE = 0.52        # share of the light that remains in a shadow
_RGB = {"road": (112, 112, 114), "worn paint": (150, 150, 147), "paint": (232, 231, 224), "manhole": (72, 70, 68),
        "gutter": (152, 150, 145), "curb face": (120, 118, 112), "curb stone": (172, 168, 160), "sidewalk": (158, 151, 142),
        "shoulder": (146, 132, 108), "verge": (94, 114, 66)}
_COLOURS = np.zeros((len(LABEL), 3))
for _name, _colour in _RGB.items():
    _COLOURS[LABEL[_name]] = _colour
_LACQUERS = np.array([(228, 228, 226), (176, 180, 184), (44, 46, 52), (124, 26, 30), (38, 62, 108), (92, 96, 98)])
_GLASS = np.array([40.0, 46.0, 54.0])
_LEAVES = np.array([62.0, 92.0, 44.0])


def plates(scene: Scene, camera: Camera) -> list[tuple[float, float, float]]:
    """Signalised plates along both borders of the image, off the carriageway: (x, y, rotation) of each, m, local, and radians."""
    count = max(3, int(round(camera.width * GROUND_PIXEL / _PLATE_EVERY)) + 1)
    result = []
    for share in np.linspace(0.025, 0.975, count):
        for inward in (1, -1):
            # from the border inward to the first place without an obstacle
            down = 0.05 + 0.04 * np.arange(8)
            x, y = camera.to_map(np.full(8, share * camera.width), (down if inward > 0 else 1.0 - down) * camera.height)
            s, d = camera.to_road(scene, x, y)
            free = np.flatnonzero(_is_free(scene, x, y, PLATE_SIDE) & ((d > scene.left.edge + PLATE_SIDE) | (d < -scene.right.edge - PLATE_SIDE)))
            if len(free):
                k = free[0]
                result.append((float(x[k]), float(y[k]), float(scene.axis.heading(s[k:k + 1])[0])))
    return result


def seen_from_above(survey: SampleSurvey) -> tuple[Scene, Camera]:
    """The street and the camera over it; RoadExtractionError if the scene is no street along one axis, of which there is no image."""
    if survey.camera is None or not isinstance(survey.scene, Scene):
        raise RoadExtractionError(f"There is no UAV image of the scene {survey.settings.scene}. Leave it out, or choose a street.")
    return survey.scene, survey.camera


def _is_free(scene, x, y, around):
    """(N,) bool, places that are not under a car, a tree or a pole."""
    free = np.ones(len(x), dtype=bool)
    for obstacle in scene.obstacles:
        reach = obstacle.reach if isinstance(obstacle, Crown) else min(obstacle.reach, 2.4)
        free &= np.hypot(x - obstacle.x, y - obstacle.y) > reach + around
    return free


def _paint_corners(scene, camera):
    """(kinds, x, y) of corners of markings within the image, a subset of distant ones."""
    kinds, s, d = [], [], []
    for marking in scene.paint.markings:
        for outline in marking.outlines():
            inside = (outline[:, 0] >= camera.stations[0]) & (outline[:, 0] <= camera.stations[1])
            kinds += [marking.kind] * int(inside.sum())
            s.append(outline[inside, 0])
            d.append(outline[inside, 1])
    if not kinds:
        return [], np.empty(0), np.empty(0)
    x, y = scene.axis.to_map(np.concatenate(s), np.concatenate(d))
    free = np.flatnonzero(_is_free(scene, x, y, _CLEAR))
    corners = free[_apart(x[free], y[free], _CORNERS)] if len(free) else free
    return [kinds[k] for k in corners], x[corners], y[corners]


def _apart(x, y, count):
    """Indices of places by farthest-point sampling."""
    sampled = [0]
    distance = np.hypot(x - x[0], y - y[0])
    while len(sampled) < min(count, len(x)) and distance.max() > 1.0:
        sampled.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.hypot(x - x[sampled[-1]], y - y[sampled[-1]]))
    return np.array(sampled)


def uav_control_points(survey: SampleSurvey) -> Features:
    """Ground control points as a surveyor measures them: Features CONTROL_POINTS in map coordinates.

    Map coordinates have a standard deviation of 8 mm, places in the image one of a quarter of a pixel. Every third corner of a
    marking is a check point.
    """
    from shapely import Point

    scene, camera = seen_from_above(survey)
    origin = np.array(survey.settings.origin)
    kinds, x, y = _paint_corners(scene, camera)
    laid = plates(scene, camera)
    kinds = kinds + ["plate"] * len(laid)
    x, y = np.append(x, [plate[0] for plate in laid]), np.append(y, [plate[1] for plate in laid])
    pixel, line = camera.to_pixel(x, y)
    s, d = camera.to_road(scene, x, y)
    z = scene.height(s, d)
    order = np.argsort(s, kind="stable")
    random = np.random.default_rng([survey.settings.seed, 4])
    surveyed, pointed = _SURVEYED * random.standard_normal((2, len(x))), _POINTED * random.standard_normal((2, len(x)))
    layer = Features("PointZ", CONTROL_POINTS, crs=survey.crs)
    checks = set(order[[k < len(x) - len(laid) for k in order]][::_EVERY_CHECK].tolist())
    for number, k in enumerate(order, 1):
        xyz = np.array([x[k] + surveyed[0, k], y[k] + surveyed[1, k], z[k]]) + origin
        layer.add(Point(xyz), point=number, role="check" if k in checks else "control",
                  pixel=pixel[k] + pointed[0, k], line=line[k] + pointed[1, k], kind=kinds[k])
    return layer

class _StreetColours:
    """Colours of the ground and of the objects on it."""

    def __init__(self, scene: Scene, camera: Camera, seed: int):
        self.scene, self.camera, self.seed = scene, camera, seed
        self._plates = plates(scene, camera)

    def colours(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(N, 3) colours, 0 to 255, of (N,) local places seen from vertically above."""
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
        """Colours of the ground without objects."""
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
            repaired = (s >= start) & (s <= end) & (d >= right) & (d <= left) & (label == LABEL["road"])
            light[repaired] *= 1.0 - 0.35 * (1.0 - factor)
        # joints between slabs of one metre
        walk = np.flatnonzero(label == LABEL["sidewalk"])
        light[walk[(s[walk] % 1.0) < 0.03]] *= 0.80
        return colours * np.maximum(light, 0.3)[:, None]

    def _lay_plates(self, colours, x, y):
        """Draw the signalised plates: black and white quarters, whose common corner is the point."""
        for at_x, at_y, turn in self._plates:
            near = _within(x, y, at_x, at_y, PLATE_SIDE)
            a = (x[near] - at_x) * np.cos(turn) + (y[near] - at_y) * np.sin(turn)
            b = (y[near] - at_y) * np.cos(turn) - (x[near] - at_x) * np.sin(turn)
            on = np.maximum(np.abs(a), np.abs(b)) < PLATE_SIDE / 2
            colours[near[on]] = np.where((a * b > 0)[on, None], 236.0, 26.0)

    def _shade(self, colours, obstacle, x, y, z):
        """Darken the ground where an obstacle hides the sun."""
        throw = (obstacle.top - z.min()) / _SUN[2] * _SUN[:2]
        middle = obstacle.x - throw[0] / 2, obstacle.y - throw[1] / 2
        near = _within(x, y, *middle, obstacle.reach + np.hypot(*throw) / 2)
        if len(near) == 0:
            return
        direction = np.repeat((_SUN / np.linalg.norm(_SUN))[:, None], len(near), axis=1)
        hit, *_ = obstacle.hits(np.stack([x[near], y[near], z[near]]), direction, self._chance(obstacle, x))
        colours[near[np.isfinite(hit)]] *= _SHADE

    def _cover(self, colours, number, obstacle, x, y):
        """Draw an obstacle as seen from above."""
        near = _within(x, y, obstacle.x, obstacle.y, obstacle.reach)
        if len(near) == 0:
            return
        if isinstance(obstacle, Post):
            colours[near] = 128.0
            return
        origin = np.stack([x[near], y[near], np.full(len(near), obstacle.z + 30.0)])
        down = np.repeat(np.array([[0.0], [0.0], [-1.0]]), len(near), axis=1)
        hit, cosine, brightness = obstacle.hits(origin, down, self._chance(obstacle, x))
        visible = np.flatnonzero(np.isfinite(hit) & (cosine > 0))
        if obstacle.label == LABEL["car"]:
            lacquer = _LACQUERS[number % len(_LACQUERS)]
            glass = (np.abs(brightness[visible] - 0.12) < 1e-9)[:, None]
            colours[near[visible]] = np.where(glass, _GLASS, lacquer) * (0.45 + 0.55 * cosine[visible])[:, None]
        else:
            colours[near[visible]] = _LEAVES * (0.45 + 0.9 * cosine[visible])[:, None]

    def _chance(self, obstacle, x):
        return np.random.default_rng([self.seed, 6, int(1000 * obstacle.x) & 0xFFFF, len(x) & 0xFFFF])


def _within(x, y, at_x, at_y, reach):
    """Indices of the places within `reach` of a place."""
    if x.min() > at_x + reach or x.max() < at_x - reach or y.min() > at_y + reach or y.max() < at_y - reach:
        return np.empty(0, dtype=np.intp)
    return np.flatnonzero((x - at_x) ** 2 + (y - at_y) ** 2 < reach**2)


@gdal_exceptions()
def write_uav_image(survey: SampleSurvey, path: str | os.PathLike[str], progress: Progress | None = None) -> None:
    """Write the UAV image of a simulated survey, an RGB TIFF without a position on the map, with position tags.

    The file appears when it is complete; RoadExtractionError if it cannot be written.
    """
    from osgeo import gdal

    progress = progress or Progress()
    scene, camera = seen_from_above(survey)
    street = _StreetColours(scene, camera, survey.settings.seed)
    unfinished = unfinished_path(path, ".tif")
    dataset = None
    try:
        dataset = gdal.GetDriverByName("GTiff").Create(str(unfinished), camera.width, camera.height, 3, gdal.GDT_Byte, [
            "TILED=YES", f"BLOCKXSIZE={_TILE}", f"BLOCKYSIZE={_TILE}", "COMPRESS=JPEG", "JPEG_QUALITY=92", "PHOTOMETRIC=YCBCR"])
        tags = camera_tags(camera, survey.settings.origin, survey.crs)
        if tags:
            dataset.SetMetadata([tags], "xml:XMP")
        for column in range(0, camera.width, _TILE):
            progress.report(column / camera.width)
            width = min(_TILE, camera.width - column)
            for row in range(0, camera.height, 2 * _TILE):
                height = min(2 * _TILE, camera.height - row)
                tile = _render(street, camera, column, row, width, height)
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
    progress.report(1.0)


def _render(street, camera, column, row, width, height):
    """(height, width, 3) uint8 of one tile."""
    pixel = np.arange(column - _HALO, column + width + _HALO) + 0.5
    line = np.arange(row - _HALO, row + height + _HALO) + 0.5
    across, down = (axis.ravel() for axis in np.meshgrid(pixel, line))
    colours = street.colours(*camera.to_map(across, down)).reshape(len(line), len(pixel), 3)
    colours = cv2.GaussianBlur(colours, (0, 0), _BLUR)[_HALO:-_HALO, _HALO:-_HALO]
    u = (pixel[_HALO:-_HALO] - camera.width / 2) / camera.half_diagonal
    v = (line[_HALO:-_HALO] - camera.height / 2) / camera.half_diagonal
    fading = 1.0 - 0.14 * (u[None, :] ** 2 + v[:, None] ** 2)
    noise = np.random.default_rng([street.seed, 5, column, row]).standard_normal(colours.shape, dtype=np.float32)
    return np.clip(np.rint(colours * fading[..., None] + _NOISE * noise), 1, 255).astype(np.uint8)
