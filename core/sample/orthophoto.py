"""The made street as a UAV sees it: asphalt, paint, sidewalks, grass, cars and trees with their shadows.

The image has no place on the map: that is for georeferencing to find. Its
pixels are what the true distortion puts there, with noise and the blur of a lens.
"""

import os
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from ..common.errors import RoadExtractionError
from ..common.features import Features
from ..common.progress import Progress
from ..common.schemas import CONTROL_POINTS
from ..io.gdal_errors import gdal_exceptions
from .obstacles import Car, Crown, Post
from .street import LABEL

# Where the pixels of the made UAV image lie on the map: an image along the road, with lens-like distortion.

MAX_IMAGE_LENGTH = 150.0    # m of road that one image shows
IMAGE_MARGIN = 7.0       # m of ground shown beyond the edges of the carriageway
GROUND_PIXEL = 0.04  # m
_END = 2.0         # m of ground before and after the road
_TILT = (0.022, -0.013)   # share of the half diagonal: what a camera not quite upright does
_LENS = (0.0016, -0.0009)  # of the third and fifth power of the distance from the middle


@dataclass(frozen=True)
class Camera:
    """A picture of width by height pixels, its rows along the road's chord, its columns across.

    Attributes
    ----------
    middle : (2,) local map coordinates of the image's middle
    heading : radians, direction of the rows, counter-clockwise from east
    width, height : pixels
    stations : (start, end) of the road that is shown
    """

    middle: np.ndarray
    heading: float
    width: int
    height: int
    stations: tuple

    @property
    def half_diagonal(self):
        return np.hypot(self.width, self.height) / 2.0

    def to_map(self, pixel, line):
        """x, y (local) of places in the image; 0, 0 is the outer corner of the first pixel.

        With u, v the place relative to the middle in half diagonals, and r its distance, the ground lies
        at (u, v)(1 + a u + b v + c r² + d r⁴): tilt and lens.
        """
        u, v = (pixel - self.width / 2) / self.half_diagonal, (line - self.height / 2) / self.half_diagonal
        square = u * u + v * v
        far = (1.0 + _TILT[0] * u + _TILT[1] * v + _LENS[0] * square + _LENS[1] * square**2) * self.half_diagonal * GROUND_PIXEL
        along, across = u * far, -v * far
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        return self.middle[0] + along * cos - across * sin, self.middle[1] + along * sin + across * cos

    def to_pixel(self, x, y):
        """Pixel and line of places on the ground (local x, y), to a millionth of a pixel."""
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        dx, dy = np.asarray(x) - self.middle[0], np.asarray(y) - self.middle[1]
        goal = (dx * cos + dy * sin) / GROUND_PIXEL + self.width / 2, -(dy * cos - dx * sin) / GROUND_PIXEL + self.height / 2
        pixel, line = goal
        for _ in range(20):
            # The distortion is a few percent, so that correcting by what is left converges fast
            at_x, at_y = self.to_map(pixel, line)
            dx, dy = np.asarray(x) - at_x, np.asarray(y) - at_y
            pixel, line = pixel + (dx * cos + dy * sin) / GROUND_PIXEL, line - (dy * cos - dx * sin) / GROUND_PIXEL
        return pixel, line

    def to_road(self, scene, x, y):
        """Station and offset of local places in the image."""
        stations = np.arange(max(scene.axis.start, -30.0), min(scene.axis.end, self.stations[1] + 30.0), 1.0)
        axis_x, axis_y = scene.axis.to_map(stations, np.zeros(len(stations)))
        cos, sin = np.cos(self.heading), np.sin(self.heading)
        # Heading turns less than a right angle from the chord, so that the way along it only grows
        s, d, *_ = scene.axis.locate(x, y, np.interp(x * cos + y * sin, axis_x * cos + axis_y * sin, stations), steps=4)
        return s, d


def camera_over(scene):
    """The Camera that shows the beginning of a road, 150 m of it at most."""
    length = min(scene.length, MAX_IMAGE_LENGTH)
    s = np.linspace(0.0, length, 200)
    x, y = scene.axis.to_map(s, np.zeros(200))
    heading = float(np.arctan2(y[-1] - y[0], x[-1] - x[0]))
    cos, sin = np.cos(heading), np.sin(heading)
    rims = [scene.axis.to_map(s, np.full(200, d)) for d in (scene.left.edge + IMAGE_MARGIN, -scene.right.edge - IMAGE_MARGIN)]
    x, y = (np.concatenate([rim[k] for rim in rims]) for k in (0, 1))
    along, across = x * cos + y * sin, y * cos - x * sin
    low = np.array([along.min() - _END, across.min()])
    high = np.array([along.max() + _END, across.max()])
    a, b = (low + high) / 2
    width, height = (int(np.ceil(side / GROUND_PIXEL)) for side in high - low)
    return Camera(np.array([a * cos - b * sin, a * sin + b * cos]), heading, width, height, (0.0, length))


# The ground control points of the made UAV image: corners of paint, and plates laid out beside the road.

PLATE_SIDE = 0.6            # m, side of a plate
_PLATE_EVERY = 40.0    # m along each rim of the image
_CORNERS = 18          # corners of paint
_CLEAR = 0.4           # m between a corner and what stands on the street
_SURVEYED = 0.008      # m, noise of the measured map coordinates
_POINTED = 0.25        # px, noise of pointing in the image
_EVERY_CHECK = 3       # each third corner of paint judges only; plates, which hold the rims, never


def plates(scene, camera):
    """[(x, y, turn)] of the plates, local coordinates: along both rims of the image, off the carriageway."""
    count = max(3, int(round(camera.width * GROUND_PIXEL / _PLATE_EVERY)) + 1)
    found = []
    for share in np.linspace(0.025, 0.975, count):
        for inward in (1, -1):
            # From the rim inwards, until nothing stands there
            down = 0.05 + 0.04 * np.arange(8)
            x, y = camera.to_map(np.full(8, share * camera.width), (down if inward > 0 else 1.0 - down) * camera.height)
            s, d = camera.to_road(scene, x, y)
            free = np.flatnonzero(_is_free(scene, x, y, PLATE_SIDE) & ((d > scene.left.edge + PLATE_SIDE) | (d < -scene.right.edge - PLATE_SIDE)))
            if len(free):
                k = free[0]
                found.append((float(x[k]), float(y[k]), float(scene.axis.heading(s[k:k + 1])[0])))
    return found


def _is_free(scene, x, y, around):
    """Which local places are not under a car, a tree or a pole."""
    free = np.ones(len(x), dtype=bool)
    for obstacle in scene.obstacles:
        reach = obstacle.reach if isinstance(obstacle, Crown) else min(obstacle.reach, 2.4)
        free &= np.hypot(x - obstacle.x, y - obstacle.y) > reach + around
    return free


def _paint_corners(scene, camera):
    """(kinds, x, y) of the corners of paint within the image, thinned to those that lie apart."""
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
    kept = free[_apart(x[free], y[free], _CORNERS)] if len(free) else free
    return [kinds[k] for k in kept], x[kept], y[kept]


def _apart(x, y, count):
    """Indices of places chosen one after the other, each the farthest from those before it."""
    chosen = [0]
    distance = np.hypot(x - x[0], y - y[0])
    while len(chosen) < min(count, len(x)) and distance.max() > 1.0:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.hypot(x - x[chosen[-1]], y - y[chosen[-1]]))
    return np.array(chosen)


def uav_control_points(survey):
    """The points as a surveyor hands them over: Features in map coordinates with pixel and line.

    Map coordinates are measured to 8 mm, places in the image to a quarter of a pixel; every third corner of paint is a check.
    """
    from shapely import Point

    scene, camera, origin = survey.scene, survey.camera, np.array(survey.settings.origin)
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
    judges = set(order[[k < len(x) - len(laid) for k in order]][::_EVERY_CHECK].tolist())
    for number, k in enumerate(order, 1):
        place = np.array([x[k] + surveyed[0, k], y[k] + surveyed[1, k], z[k]]) + origin
        layer.add(Point(place), point=str(number), role="check" if k in judges else "control",
                  pixel=float(pixel[k] + pointed[0, k]), line=float(line[k] + pointed[1, k]), kind=kinds[k])
    return layer

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
            near = _within(x, y, at_x, at_y, PLATE_SIDE)
            a = (x[near] - at_x) * np.cos(turn) + (y[near] - at_y) * np.sin(turn)
            b = (y[near] - at_y) * np.cos(turn) - (x[near] - at_x) * np.sin(turn)
            on = np.maximum(np.abs(a), np.abs(b)) < PLATE_SIDE / 2
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
            progress.report(column / camera.width)
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
    progress.report(1.0)


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
