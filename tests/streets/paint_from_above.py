"""Paint on a road, as an intensity image shows it and as a photo does: known geometry for both."""

from dataclasses import dataclass

import cv2
import numpy as np
from lanewright.core.io.geotiff import IntensityImage, new_geotiff
from lanewright.products.overlay.control_points import open_image
from lanewright.products.overlay.rough_place import RoughPlace
from osgeo import gdal
from pyproj import CRS

gdal.UseExceptions()
UTM = CRS.from_epsg(32650).to_wkt()
EAST, NORTH = 610_400.0, 2_710_300.0   # the outer corner of the intensity image
_FINE = 0.02                           # m, cells in which paint is drawn; photos and intensity images are taken from them


def bar(x, y, length, width, turn=0.0):
    """Corners of a rectangle, (4, 2) m, about its middle; `turn` in degrees."""
    a = np.radians(turn)
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * [length / 2, width / 2]
    return corners @ [[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]] + [x, y]


def dashes(y, start, end, length=3.0, period=9.0):
    return [bar(x + length / 2, y, length, 0.15) for x in np.arange(start, end - length, period)]


def arrow(x, y):
    return [bar(x, y, 3.0, 0.2), np.array([(x + 1.5, y - 0.5), (x + 1.5, y + 0.5), (x + 2.8, y)])]


def zebra(x, y, count=8):
    return [bar(x, y + 1.0 * k, 3.0, 0.5) for k in range(count)]


def street():
    """Edge lines, dashes, a zebra crossing, stop lines and arrows on 80 m of road, 10 m wide; x to the east, y to the north from EAST, NORTH."""
    return [bar(40, -11, 78, 0.15), bar(40, -19, 78, 0.15), *dashes(-15, 3, 34), *dashes(-15, 48, 78), *zebra(42, -18.5, 8),
            bar(38, -13, 0.5, 3.6), bar(46, -17, 0.5, 3.6), *arrow(30, -13), *arrow(53, -17), *arrow(66, -13)]


@dataclass
class Ground:
    """Paint on asphalt, and where the laser saw the road.

    paint : list of (N, 2) polygons, m from EAST, NORTH
    road : (west, south, east, north) m, the carriageway; the laser sees nothing else
    """

    paint: list
    road: tuple = (0.0, -20.0, 80.0, -10.0)
    size: tuple = (80.0, 30.0)

    def coverage(self):
        """(H, W) 0 to 1, share of paint in fine cells."""
        image = np.zeros((round(self.size[1] / _FINE), round(self.size[0] / _FINE)), np.float32)
        for polygon in self.paint:
            places = np.rint(np.column_stack([polygon[:, 0], -polygon[:, 1]]) / _FINE * 256 - 128).astype(np.int32)
            cv2.fillPoly(image, [places], 1.0, cv2.LINE_8, 8)
        return image

    def intensity_image(self, path, noise=300.0, seed=1, cell=0.04, corner=(EAST, NORTH), crs=UTM):
        """An IntensityImage of the road: counts of 5000 for asphalt, 18 000 for paint."""
        step = round(cell / _FINE)
        cover = cv2.resize(self.coverage(), None, fx=1 / step, fy=1 / step, interpolation=cv2.INTER_AREA)
        values = 5000 + 13_000 * cover + noise * np.random.default_rng(seed).standard_normal(cover.shape)
        west, south, east, north = (round(abs(v) / cell) for v in self.road)
        inside = np.zeros(cover.shape, bool)
        inside[north:south, west:east] = True
        with new_geotiff(path, cover.shape[1], cover.shape[0], (corner[0], cell, 0.0, corner[1], 0.0, -cell), crs) as image:
            image.write(0, 0, np.where(inside, values, -9999.0))
        return IntensityImage.open(path)

    def photo(self, path, camera, light=None, noise=5.0, seed=2, dark_paint=False, driver="PNG"):
        """A SourceImage of the ground: grass, asphalt at 110, paint at 230; `light` multiplies what it shows, by place."""
        pixel, line = (np.arange(n) + 0.5 for n in (camera.width, camera.height))
        x, y = camera.to_map(*(axis.ravel() for axis in np.meshgrid(pixel, line)))
        shape = camera.height, camera.width
        x, y = (axis.reshape(shape).astype(np.float32) for axis in (x - EAST, y - NORTH))
        # as large as a pixel of the photo sees it
        cover = cv2.GaussianBlur(self.coverage(), (0, 0), max(0.4 * camera.size / _FINE, 0.5))
        cover = cv2.remap(cover, x / _FINE - 0.5, -y / _FINE - 0.5, cv2.INTER_LINEAR, borderValue=0.0)
        west, south, east, north = self.road
        road = (x > west) & (x < east) & (y > south) & (y < north)
        random = np.random.default_rng(seed)
        grass = 80 + 12 * cv2.GaussianBlur(random.standard_normal(shape).astype(np.float32), (0, 0), 3) * 8
        values = np.where(road, 110 + 120 * cover, grass)
        if light is not None:
            values = values * light(x, y)
        values = values + noise * random.standard_normal(shape)
        if dark_paint:
            values = 255 - values
        memory = gdal.GetDriverByName("MEM").Create("", camera.width, camera.height, 1)
        memory.WriteRaster(0, 0, camera.width, camera.height, np.clip(np.rint(values), 1, 255).astype(np.uint8).tobytes())
        gdal.GetDriverByName(driver).CreateCopy(str(path), memory)
        return open_image(path)


@dataclass
class Overhead:
    """A camera that looks down: its middle (m, map), the turn of its rows (radians), m of a pixel, and the tilt that scales its sides."""

    x: float = EAST + 40.0
    y: float = NORTH - 15.0
    turn: float = 0.0
    size: float = 0.04
    width: int = 1900
    height: int = 640
    tilt: float = 0.0

    def to_map(self, pixel, line):
        u, v = (pixel - self.width / 2) * self.size, -(line - self.height / 2) * self.size
        far = 1.0 + self.tilt * u / (0.5 * self.width * self.size)
        u, v = u * far, v * far
        cos, sin = np.cos(self.turn), np.sin(self.turn)
        return self.x + u * cos - v * sin, self.y + u * sin + v * cos


def about(camera, dx=6.0, dy=-5.0, turn=0.15, size=1.06, reach=15.0, loose=0.35, size_range=0.15):
    """A rough place such as a drone's tags give: metres, a tenth of a radian and some percent off."""
    return RoughPlace(camera.x + dx, camera.y + dy, reach, camera.turn + turn, loose, camera.size * size, size_range, "position tags")


def near(camera, size=1.005):
    """A place such as a world file gives, for tests of what follows the search: decimetres, a degree and half a percent off."""
    return about(camera, 0.6, -0.5, 0.015, size, 3.0, 0.05, 0.03)


def errors(proposal, camera):
    """(N,) m between the places of pairs on the map and where the camera truly saw them."""
    east, north = camera.to_map(proposal.pixel, proposal.line)
    return np.hypot(east - proposal.easting, north - proposal.northing)
