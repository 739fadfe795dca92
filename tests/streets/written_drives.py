"""One drive of 40 positions, written down as receivers, software and offices write it."""

from datetime import datetime, timedelta

import numpy as np
from pyproj import Transformer

ROWS = 40
GPS = 1_318_204_000.0 + 0.25 * np.arange(ROWS)      # 13 October 2021, 23:46:40 GPS time
WEEK, OF_WEEK, OF_DAY = 2179, GPS % 604_800, GPS % 86_400
TURN = np.linspace(0.0, 0.8, ROWS)
X, Y = 610_475.816 + 60 * np.sin(TURN) * 1.5, 2_710_159.003 - 60 * (1 - np.cos(TURN))
Z = 24.0286 + 0.4 * np.sin(TURN * 9)
ROLL, PITCH, HEADING = 1.3 * np.sin(TURN * 20), 0.9 * np.cos(TURN * 20), np.degrees(np.arctan2(np.gradient(X), np.gradient(Y))) % 360
LON, LAT = Transformer.from_crs(32650, 4326, always_xy=True).transform(X, Y)
ECEF = np.array(Transformer.from_crs(4979, 4978, always_xy=True).transform(LON, LAT, Z))
CLOCKS = [datetime(1980, 1, 6) + timedelta(seconds=float(s)) for s in GPS]
UTC_CLOCKS = [when - timedelta(seconds=18) for when in CLOCKS]


def rows(*columns, mark=","):
    """Lines of columns, each values with a format or texts."""
    texts = [[column[1].format(value) for value in column[0]] if isinstance(column, tuple) else list(map(str, column)) for column in columns]
    return "".join(mark.join(row) + "\n" for row in zip(*texts))


def dms(values, form="{0:4d} {1:02d} {2:09.6f}", hemispheres=""):
    """Degrees, minutes and seconds of angles."""
    found = []
    for value in values:
        seconds = round(abs(value) * 3600, 6)
        parts = int(seconds // 3600), int(seconds % 3600 // 60), seconds % 60
        found.append(form.format(*parts) + (hemispheres[int(value < 0)] if hemispheres else ""))
    return found


def nmea_angle(values, digits):
    return [f"{int(v):0{digits}d}{v % 1 * 60:010.7f}" for v in values]


def clock(form, times=CLOCKS):
    """Texts of times; %f has three digits."""
    return [when.strftime(form.replace("%f", f"{when.microsecond // 1000:03d}")) for when in times]


MAP = ((X, "{:.4f}"), (Y, "{:.4f}"), (Z, "{:.4f}"))
GEO = ((LAT, "{:.10f}"), (LON, "{:.10f}"), (Z, "{:.4f}"))
