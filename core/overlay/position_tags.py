"""What a camera wrote into its image about where it hung: EXIF, and the XMP of drones."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..io.local_files import gdal_exceptions, open_raster
from .source_image import SourceImage

FULL_FRAME_DIAGONAL = 43.27  # mm, of the 24 x 36 mm that a focal length "in 35 mm film" refers to
_STEEP = 45.0                # ° below the horizon from which a camera looks down rather than ahead
_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:/\d+)?"
# XMP names, with or without their prefix; DJI wrote the second spelling of longitude for years
_LATITUDE, _LONGITUDE = ("GpsLatitude", "GPSLatitude"), ("GpsLongitude", "GpsLongtitude", "GPSLongitude")


@dataclass(frozen=True)
class PositionTags:
    """Where a camera hung and how it looked; None where the image does not say.

    Attributes
    ----------
    latitude, longitude : degrees, WGS 84
    heading : degrees clockwise from north, of the top of the image
    height : m above the ground, or above where the drone took off
    focal_length : mm, converted to 35 mm film
    """

    latitude: float
    longitude: float
    heading: float | None = None
    height: float | None = None
    focal_length: float | None = None

    def pixel_size(self, image: SourceImage) -> float | None:
        """m of a pixel on the ground below a camera that looks straight down; None where height or focal length are missing."""
        if not self.height or not self.focal_length or self.height <= 0 or self.focal_length <= 0:
            return None
        return self.height * FULL_FRAME_DIAGONAL / (self.focal_length * float(np.hypot(image.width, image.height)))


@gdal_exceptions()
def read_position_tags(image: SourceImage) -> PositionTags | None:
    """The PositionTags of an image; None where it has no latitude and longitude."""

    dataset = open_raster(image.path)
    packets = dataset.GetMetadata("xml:XMP")
    exif = {**(dataset.GetMetadata("EXIF") or {}), **(dataset.GetMetadata() or {})}
    return position_tags({_text(name): _text(value) for name, value in exif.items()},
                         "".join(map(_text, packets)) if isinstance(packets, list) else "")


def _text(value):
    """What GDAL gives as text; it gives bytes where they are not UTF-8."""
    return value.decode("latin-1") if isinstance(value, bytes) else value


def position_tags(exif: Mapping[str, str], xmp: str = "") -> PositionTags | None:
    """The same from EXIF items, named as GDAL names them, and from the text of an XMP packet."""
    latitude = _first(_xmp_degrees(xmp, _LATITUDE), _exif_degrees(exif, "Latitude"))
    longitude = _first(_xmp_degrees(xmp, _LONGITUDE), _exif_degrees(exif, "Longitude"))
    # a receiver without a fix writes zeros
    if latitude is None or longitude is None or not abs(latitude) <= 90 or not abs(longitude) <= 180 or latitude == longitude == 0:
        return None
    pitch = _xmp_number(xmp, "GimbalPitchDegree")
    heading = _first(_xmp_number(xmp, "GimbalYawDegree") if pitch is None or pitch < -_STEEP else None,
                     _xmp_number(xmp, "FlightYawDegree"), _numbers(exif.get("EXIF_GPSImgDirection", "")))
    return PositionTags(
        latitude, longitude, heading, _xmp_number(xmp, "RelativeAltitude"),
        _first(_numbers(exif.get("EXIF_FocalLengthIn35mmFilm", "")), _xmp_number(xmp, "FocalLengthIn35mmFilm")))


def _first(*values):
    return next((value for value in values if value is not None), None)


def _xmp_text(xmp, name):
    """The text of an attribute or an element, "" where there is none."""
    found = re.search(rf"\b{name}\s*=\s*[\"']([^\"']*)[\"']|<(?:[\w-]+:)?{name}>([^<]*)<", xmp)
    return (found.group(1) or found.group(2) or "").strip() if found else ""


def _xmp_number(xmp, name):
    return _numbers(_xmp_text(xmp, name))


def _xmp_degrees(xmp, names):
    for name in names:
        text = _xmp_text(xmp, name)
        value = _numbers(text)
        if value is not None:
            return -abs(value) if text[-1:].upper() in ("S", "W") else value
    return None


def _exif_degrees(exif, name):
    value = _numbers(exif.get(f"EXIF_GPS{name}", ""))
    if value is None:
        return None
    return -value if exif.get(f"EXIF_GPS{name}Ref", "").strip().upper()[:1] in ("S", "W") else value


def _numbers(text):
    """The number in a text; of several (degrees, minutes, seconds) each counts a sixtieth of the one before."""
    parts = []
    for one in re.findall(_NUMBER, text):
        above, _, below = one.partition("/")
        parts.append(float(above) / (float(below) or np.nan) if below else float(above))
    value = sum(part / 60.0**k for k, part in enumerate(parts[:3]))
    return value if parts and np.isfinite(value) else None
