"""The position tags that a drone writes into its image: about where it hung, about where it looked, how high it flew."""

from __future__ import annotations

import numpy as np

from .camera import GROUND_PIXEL, Camera

FOCAL_LENGTH = 24.0          # mm, converted to 35 mm film: a wide-angle lens, as drones carry
_FILM_DIAGONAL = 43.27       # mm, of 24 x 36 mm film
_RECEIVER = (-2.3, 1.7)      # m east and north: a satellite receiver without corrections
_COMPASS = 3.0               # degrees
_TAKE_OFF = 1.04             # the height is measured from where the drone took off, not from the road
_NORTH_STEP = 0.001          # degrees


def camera_tags(camera: Camera, origin: tuple[float, float, float], crs: str) -> str:
    """The XMP packet of the image of a camera, with the errors that such tags have; "" where the CRS knows no latitude and longitude.

    `origin`: m, map coordinates of local 0, 0. `crs`: WKT of the map.
    """
    from pyproj import Transformer
    from pyproj.exceptions import CRSError, ProjError

    from ..core.io.crs import horizontal_part, parse_crs

    east, north = (float(v + shift + error) for v, shift, error in zip(camera.middle, origin, _RECEIVER))
    try:
        to_degrees = Transformer.from_crs(horizontal_part(parse_crs(crs)), "EPSG:4326", always_xy=True)
        longitude, latitude = to_degrees.transform(east, north)
        x, y = to_degrees.transform([longitude] * 2, [latitude, latitude + _NORTH_STEP], direction="INVERSE")
    except (CRSError, ProjError):
        return ""
    if not np.isfinite([longitude, latitude, *x, *y]).all():
        return ""
    convergence = np.degrees(np.arctan2(y[1] - y[0], x[1] - x[0])) - 90.0   # of true north from grid north, counter-clockwise
    heading = (convergence - np.degrees(camera.heading) + _COMPASS + 180.0) % 360.0 - 180.0
    height = GROUND_PIXEL * FOCAL_LENGTH * 2.0 * camera.half_diagonal / _FILM_DIAGONAL * _TAKE_OFF
    return f'''<?xpacket begin="" id="W5M0MpCehiHzreSzNTczkc9d"?>
<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
<rdf:Description rdf:about="" xmlns:drone-dji="http://www.dji.com/drone-dji/1.0/" xmlns:exif="http://ns.adobe.com/exif/1.0/"
 drone-dji:GpsLatitude="{latitude:+.8f}" drone-dji:GpsLongitude="{longitude:+.8f}" drone-dji:RelativeAltitude="{height:+.2f}"
 drone-dji:GimbalPitchDegree="-89.90" drone-dji:GimbalYawDegree="{heading:+.2f}" exif:FocalLengthIn35mmFilm="{FOCAL_LENGTH:.0f}"/>
</rdf:RDF></x:xmpmeta>
<?xpacket end="w"?>'''
