"""Where an image lies roughly, before any control point: by two points, its own position, its tags, or its pixel size; and cut-outs of it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.common.errors import RoadExtractionError
from ...core.io.crs import horizontal_part, parse_crs, same_crs
from ...core.io.geotiff import IntensityImage
from ...core.io.local_files import gdal_exceptions, open_raster
from ...core.lazy import cv2, gdal, pyproj
from .control_points import DISABLED, ControlPoints, SourceImage

_POINTED = 2.0          # m by which a point pointed at by hand may be off
_PLACED_TURN, _PLACED_SIZE = np.radians(3.0), 0.03   # of an image with a position of its own, such as a world file
_TAGGED_TURN, _TAGGED_SIZE = np.radians(20.0), 0.15  # of tags: the gimbal's compass; a height above the take-off, not above the road
_GIVEN_SIZE = 0.10      # of a pixel size that was given
_NORTH_STEP = 0.001     # degrees of latitude over which the direction of north is taken


@dataclass(frozen=True)
class RoughPlace:
    """A rough similarity from an image to the map, and how far it may be off."""

    x: float   # x, y: m, map coordinates of the image's middle; NaN where nothing is known of them
    y: float
    reach: float   # m, how far off these may be; infinite where nothing is known
    turn: float   # radians, counter-clockwise, from the rows of the image to east
    turn_range: float   # radians, how far off that may be; pi where nothing is known
    size: float   # m of a pixel
    size_range: float   # how far off that may be, as a share
    source: str   # what it was taken from, for the report


def rough_place(image: SourceImage, crs: str, reach: float, pixel_size: float = 0.0, points: ControlPoints | None = None) -> RoughPlace:
    """Where an image lies roughly: by given points, else by its own position, else by its tags, else by its pixel size alone.

    crs : WKT of the map, projected in metres; "" where unknown
    reach : m, how far off a position of the image may be
    pixel_size : m; 0 where unknown
    points : two or more ControlPoints in that CRS, or None
    Raises RoadExtractionError if nothing says how large the pixels are on the ground, or the points are too few.
    """
    middle = np.array([image.width / 2, image.height / 2])
    if points is not None:
        used = points.roles != DISABLED
        return _by_points(points.pixel[used], points.line[used], points.easting[used], points.northing[used], middle, reach)
    if image.geotransform is not None:
        return _by_geotransform(image, crs, middle, reach)
    tags = read_position_tags(image)
    size = pixel_size or (tags.pixel_size(image) if tags else None) or 0.0
    if not size:
        reason = "its tags say where the camera hung, but not how high or with what focal length" if tags else \
            "it has neither a position nor position tags"
        raise RoadExtractionError(f"Nothing tells how large the pixels of {image.path} are on the ground: {reason}. Give the pixel size, or two "
                                  "points, or a world file beside the image.")
    size_range = _GIVEN_SIZE if pixel_size else _TAGGED_SIZE
    if tags is None or not crs:
        return RoughPlace(np.nan, np.nan, np.inf, 0.0, np.pi, size, size_range, f"a pixel size of {size:.3g} m alone")
    return _by_tags(tags, crs, reach, size, size_range)


def _by_points(pixel, line, easting, northing, middle, reach):
    """The least-squares similarity of two or more points."""
    if len(pixel) < 2:
        raise RoadExtractionError(f"There are {len(pixel)} rough points; two or more are needed, far apart in the image.")
    factor, shift = similarity(pixel, line, easting, northing)
    spread = float(np.hypot(np.ptp(easting), np.ptp(northing)))
    if not np.isfinite(factor) or spread < 2.0 * _POINTED:
        raise RoadExtractionError(f"The rough points lie {spread:.1f} m apart. Choose two that are far apart in the image.")
    loose = min(0.3, 2.0 * _POINTED / spread)
    centre = shift + factor * complex(middle[0], -middle[1])
    # what lies beyond the points is off by more than they are
    beyond = 1.0 + abs(centre - complex(easting.mean(), northing.mean())) / spread
    return RoughPlace(centre.real, centre.imag, min(reach, 2.0 * _POINTED * beyond), float(np.angle(factor)), max(np.radians(1.0), loose),
                      abs(factor), max(0.01, loose), f"{len(pixel)} given points")


def similarity(pixel: np.ndarray, line: np.ndarray, easting: np.ndarray, northing: np.ndarray) -> tuple[complex, complex]:
    """(factor, shift) of the least-squares similarity from an image to the map, as complex numbers: map = shift + factor * (pixel - i line).

    Of (N,) places, N at least 2; NaN where all lie in one place.
    """
    source, target = pixel - 1j * line, easting + 1j * northing
    a = source - source.mean()
    with np.errstate(all="ignore"):
        factor = ((target - target.mean()) * a.conj()).sum() / (np.abs(a) ** 2).sum()
    return complex(factor), complex(target.mean() - factor * source.mean())


def _by_geotransform(image, crs, middle, reach):
    """By the image's own position, in whatever CRS it is given."""
    x0, xp, xl, y0, yp, yl = image.geotransform
    pixel, line = (axis.ravel() for axis in np.meshgrid([0.0, image.width], [0.0, image.height]))
    easting, northing = to_map(x0 + xp * pixel + xl * line, y0 + yp * pixel + yl * line, image.crs, crs)
    factor, shift = similarity(pixel, line, easting, northing)
    centre = shift + factor * complex(middle[0], -middle[1])
    if not (np.isfinite(centre) and abs(factor) > 0):
        raise RoadExtractionError(f"The position of {image.path} cannot be taken to the CRS of the intensity image. Is its CRS the right one?")
    return RoughPlace(centre.real, centre.imag, reach, float(np.angle(factor)), _PLACED_TURN, abs(factor), _PLACED_SIZE, "the image's own position")


def _by_tags(tags, crs, reach, size, size_range):
    """By the place of the camera: the middle of an image that looks straight down lies below it."""
    x, y = to_map(np.full(2, tags.longitude), tags.latitude + np.array([0.0, _NORTH_STEP]), "EPSG:4326", crs)
    north = float(np.arctan2(y[1] - y[0], x[1] - x[0]))  # true north on the map, counter-clockwise from east
    source = "position tags"
    if tags.heading is None:
        return RoughPlace(float(x[0]), float(y[0]), reach, 0.0, np.pi, size, size_range, source)
    # the top of the image points to the heading; its rows run a right angle clockwise from there
    turn = north - np.radians(tags.heading) - np.pi / 2
    return RoughPlace(float(x[0]), float(y[0]), reach, float(np.angle(np.exp(1j * turn))), _TAGGED_TURN, size, size_range, source)


def to_map(x: np.ndarray, y: np.ndarray, source: str, target: str) -> tuple[np.ndarray, np.ndarray]:
    """(N,) x and y, or longitude and latitude, brought from one CRS, WKT or code, to another; where either is "" nothing is changed.

    They are infinite where a place has none in the target CRS.
    """
    a, b = parse_crs(source), parse_crs(target)
    if a is None or b is None or same_crs(a, b):
        return x, y
    moved: tuple[Any, Any] = pyproj.Transformer.from_crs(horizontal_part(a), horizontal_part(b), always_xy=True).transform(x, y)
    return np.asarray(moved[0], float), np.asarray(moved[1], float)


# What a camera wrote into its image about where it hung: EXIF, and the XMP of drones.

FULL_FRAME_DIAGONAL = 43.27  # mm, of the 24 x 36 mm that a focal length "in 35 mm film" refers to
_STEEP = 45.0                # ° below the horizon from which a camera looks down rather than ahead
_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:/\d+)?"


@dataclass(frozen=True)
class _PositionTags:
    """Where a camera hung and how it looked; None where the image does not say."""

    latitude: float   # latitude, longitude: degrees, WGS 84
    longitude: float
    heading: float | None = None   # degrees clockwise from north, of the top of the image
    height: float | None = None   # m above the ground, or above where the drone took off
    focal_length: float | None = None   # mm, converted to 35 mm film

    def pixel_size(self, image: SourceImage) -> float | None:
        """m of a pixel on the ground below a camera that looks straight down; None where height or focal length are missing."""
        if not self.height or not self.focal_length or self.height <= 0 or self.focal_length <= 0:
            return None
        return self.height * FULL_FRAME_DIAGONAL / (self.focal_length * float(np.hypot(image.width, image.height)))


@gdal_exceptions()
def read_position_tags(image: SourceImage) -> _PositionTags | None:
    """The _PositionTags of an image; None where it has no latitude and longitude."""
    dataset = open_raster(image.path)
    packets = dataset.GetMetadata("xml:XMP")
    exif = {**(dataset.GetMetadata("EXIF") or {}), **(dataset.GetMetadata() or {})}
    return position_tags({_text(name): _text(value) for name, value in exif.items()},
                         "".join(map(_text, packets)) if isinstance(packets, list) else "")


def _text(value):
    """What GDAL gives as text; it gives bytes where they are not UTF-8."""
    return value.decode("latin-1") if isinstance(value, bytes) else value


def position_tags(exif: Mapping[str, str], xmp: str = "") -> _PositionTags | None:
    """The same from EXIF items, named as GDAL names them, and from the text of an XMP packet."""
    def tag(*names):
        """The number of the first of these tags that has one; south and west are negative."""
        for name in names:
            text = exif.get(name) or _xmp_text(xmp, name)
            value = _numbers(text)
            if value is not None:
                return -abs(value) if (text + exif.get(name + "Ref", "")).strip()[-1:].upper() in ("S", "W") else value
        return None

    # of XMP with or without their prefix; DJI wrote the second spelling of longitude for years
    latitude = tag("GpsLatitude", "GPSLatitude", "EXIF_GPSLatitude")
    longitude = tag("GpsLongitude", "GpsLongtitude", "GPSLongitude", "EXIF_GPSLongitude")
    # a receiver without a fix writes zeros
    if latitude is None or longitude is None or not abs(latitude) <= 90 or not abs(longitude) <= 180 or latitude == longitude == 0:
        return None
    pitch = tag("GimbalPitchDegree")
    heading = tag(*["GimbalYawDegree"] * (pitch is None or pitch < -_STEEP), "FlightYawDegree", "EXIF_GPSImgDirection")
    return _PositionTags(latitude, longitude, heading, tag("RelativeAltitude"), tag("EXIF_FocalLengthIn35mmFilm", "FocalLengthIn35mmFilm"))


def _xmp_text(xmp, name):
    """The text of an attribute or an element, "" where there is none."""
    match = re.search(rf"\b{name}\s*=\s*[\"']([^\"']*)[\"']|<(?:[\w-]+:)?{name}>([^<]*)<", xmp)
    return (match.group(1) or match.group(2) or "").strip() if match else ""


def _numbers(text):
    """The number in a text; of several (degrees, minutes, seconds) each counts a sixtieth of the one before."""
    parts = []
    for number in re.findall(_NUMBER, text):
        above, _, below = number.partition("/")
        parts.append(float(above) / (float(below) or np.nan) if below else float(above))
    value = sum(part / 60.0**k for k, part in enumerate(parts[:3]))
    return value if parts and np.isfinite(value) else None


# Pairs of cut-outs about control points: what the image and the intensity image show at the same place, north up.

_STRETCH = (1.0, 99.5)  # percentiles of a cut-out's values shown as black and white


@gdal_exceptions()
def pair_cutouts(image: SourceImage, intensity: IntensityImage, pixel: np.ndarray, line: np.ndarray, easting: np.ndarray,
                 northing: np.ndarray, half: float = 1.6, side: int = 120) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The two cut-outs of each of (N,) places in the image and the intensity image, N at least 2, the place in their middle.

    half, side : m, half the side of a cut-out, and its pixels
    Yields two (side, side, 3) uint8, red, green, blue; black where there is nothing.
    """
    dataset = open_raster(image.path)
    if image.palette:
        dataset = gdal.Translate("", dataset, format="VRT", rgbExpand="rgb")
    bands = (1, 2, 3) if dataset.RasterCount - image.has_alpha >= 3 else (1, 1, 1)
    factor, _ = similarity(pixel, line, easting, northing)
    per_cell = 2.0 * half / side
    for pair in zip(pixel, line, easting, northing):
        yield _photo(dataset, bands, image, pair[:2], 1.0 / factor, per_cell, side), _intensity(intensity, pair[2:], half, side)


def _photo(dataset, bands, image, place, factor, per_cell, side):
    """A part of the image, turned as the map is; `factor`: pixels per metre, as a complex number."""
    reach = int(np.ceil(0.75 * side * per_cell * abs(factor))) + 2
    (c0, c1), (r0, r1) = ((max(0, int(at) - reach), min(size, int(at) + reach)) for at, size in zip(place, (image.width, image.height)))
    if c0 >= c1 or r0 >= r1:
        return np.zeros((side, side, 3), np.uint8)
    window = np.stack([np.frombuffer(dataset.GetRasterBand(band).ReadRaster(c0, r0, c1 - c0, r1 - r0, buf_type=gdal.GDT_Float32), np.float32).reshape(
        r1 - r0, c1 - c0) for band in bands], axis=2)
    # from pixels of the cut-out, right and down, to those of the window
    a, b = factor.real * per_cell, factor.imag * per_cell
    matrix = np.array([[a, b, 0.0], [-b, a, 0.0]])
    matrix[:, 2] = np.array([place[0] - c0 - 0.5, place[1] - r0 - 0.5]) - matrix[:, :2] @ [side / 2 - 0.5, side / 2 - 0.5]
    shrink = per_cell * abs(factor)
    smooth = cv2.GaussianBlur(window, (0, 0), 0.4 * shrink) if shrink > 1.5 else window
    cut = cv2.warpAffine(smooth, matrix, (side, side), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP)
    return np.clip(np.rint(cut), 0, 255).astype(np.uint8) if image.kind == "byte" else _stretched(cut)


def _intensity(intensity, place, half, side):
    """A part of the intensity image."""
    column, row = (float(v[0]) for v in intensity.pixel_of(np.array([place[0]]), np.array([place[1]])))
    reach = int(np.ceil(half / intensity.cell_size)) + 2
    first = int(column) - reach, int(row) - reach
    values = intensity.read_pixels(*first, 2 * reach, 2 * reach)
    step = 2.0 * half / side / intensity.cell_size
    matrix = np.array([[step, 0.0, 0.0], [0.0, step, 0.0]])
    matrix[:, 2] = np.array([column - first[0] - 0.5, row - first[1] - 0.5]) - step * (side / 2 - 0.5)
    cut = cv2.warpAffine(values, matrix, (side, side), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP, borderValue=float("nan"))
    return np.repeat(_stretched(cut[..., None]), 3, axis=2)


def _stretched(values):
    """(H, W, C) values as bytes, dark to light; black where there are none."""
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros(values.shape, np.uint8)
    low, high = np.percentile(values[finite], _STRETCH)
    share = np.clip((np.where(finite, values, low) - low) / max(float(high - low), 1e-9), 0.0, 1.0)
    return np.where(finite, np.rint(30 + 225 * share), 0).astype(np.uint8)
