"""The course of one marking line in plan and height: places from its paint, a curve through them."""

from dataclasses import dataclass

import numpy as np

from ..curves.choice import fit_curve
from ..curves.fit import Fit, median
from ..curves.spline import fit_spline, smooth_profile
from ..errors import RoadExtractionError

FAINT = 3            # points that a place must have to count, where there are enough such places
GUIDED_GAP = 4.0     # m: in a longer gap the curve is guided parallel to the other lines
GUIDE = 2.0          # m between guiding places
LEVEL = 3.0          # m at either side of a gap that say where the guide begins and ends
HEIGHT_SMOOTHING = 3.0  # m
STEP = 0.5           # m between vertices


@dataclass
class LineShape:
    """A line that can be drawn between two stations.

    fit : Fit of the curve; residuals belong to the places `s`
    s : (K,) stations of the places
    """

    fit: Fit
    s: np.ndarray
    _station_to_u: tuple
    _height: object

    def u(self, s):
        """Arc length on the curve at stations s, going on evenly beyond the ends."""
        stations, lengths = self._station_to_u
        inside = np.interp(s, stations, lengths)
        return inside + np.minimum(s - stations[0], 0.0) + np.maximum(s - stations[-1], 0.0)

    def draw(self, first, last):
        """(M, 3) local places from station `first` to `last`, at most half a metre apart."""
        ends = self.u(np.array([first, last]))
        count = max(2, int(np.ceil((ends[1] - ends[0]) / STEP - 1e-9)) + 1)
        u = np.linspace(ends[0], ends[1], count)
        stations, lengths = self._station_to_u
        s = np.interp(u, lengths, stations) + np.minimum(u - lengths[0], 0.0) + np.maximum(u - lengths[-1], 0.0)
        return np.c_[self.fit.curve.at(u), self._height(s)]


def shape_of(line, road, drift, track_height, span, settings):
    """The LineShape of a linked line.

    Parameters
    ----------
    line : Line
    road : Road
    drift : Drift, how the painted lines of the road run together
    track_height : function of stations (N,), height of the trajectory; the line's height is
        smoothed as the difference to it, so that it goes on along the road's slope
    span : (first, last) stations to be drawn, which may reach beyond the paint
    settings : LineSettings

    Returns
    -------
    LineShape, and whether the wanted curve could be fitted (automatic replaces it where not)
    """
    s, d, z, weight = line.places()
    strong = weight >= FAINT
    if strong.sum() >= max(4, 0.5 * len(s)):
        s, d, z, weight = s[strong], d[strong], z[strong], weight[strong]
    order = np.argsort(s, kind="stable")
    s, d, z = s[order], d[order], z[order]
    guide_s, guide_d = _guides(s, d - drift.at(s), drift, span)
    all_s, all_d = np.r_[s, guide_s], np.r_[d, guide_d]
    order = np.argsort(all_s, kind="stable")
    all_s, all_d = all_s[order], all_d[order]
    along = _along(road, all_s, all_d)
    x, y = road.to_map(s, d)
    fit, as_wanted = _fitted(x, y, settings)
    if fit.curve.kind == "b-spline":
        # the same curve with the guides, which are no measurements and count in no choice
        guided = fit_spline(*road.to_map(all_s, all_d), along)
        fit = Fit(guided.curve, guided.curve.foot(x, y)[1], guided.parameters)
    u, _ = fit.curve.foot(*road.to_map(all_s, all_d))
    rising = np.maximum.accumulate(u)
    keep = np.r_[True, np.diff(rising) > 1e-6]
    height = smooth_profile(s, z - track_height(s), HEIGHT_SMOOTHING)
    shape = LineShape(fit, s, (all_s[keep], rising[keep]), lambda at: height(at) + track_height(at))
    return shape, as_wanted


def _fitted(x, y, settings):
    try:
        return fit_curve(x, y, settings.curve, settings.degree), True
    except RoadExtractionError:
        return fit_curve(x, y, "automatic"), False


def _guides(s, level, drift, span):
    """Places in long gaps and beyond the ends, where nothing is painted: parallel to the other lines."""
    gaps = [(a, b) for a, b in zip(s[:-1], s[1:]) if b - a > GUIDED_GAP]
    stations, offsets = [], []
    for a, b in gaps:
        at = np.linspace(a, b, int(np.ceil((b - a) / GUIDE)) + 1)[1:-1]
        start, stop = np.searchsorted(s, a, "right"), np.searchsorted(s, b)
        before = median(level[np.searchsorted(s, a - LEVEL):start])
        after = median(level[stop:np.searchsorted(s, b + LEVEL, "right")])
        stations.append(at)
        offsets.append(np.interp(at, [a, b], [before, after]) + drift.at(at))
    for tip, end in ((s[0], span[0]), (s[-1], span[1])):
        if abs(end - tip) > GUIDE / 4:
            at = np.linspace(tip, end, int(np.ceil(abs(end - tip) / GUIDE)) + 1)[1:]
            stations.append(at)
            offsets.append(median(level[np.abs(s - tip) <= LEVEL]) + drift.at(at))
    if not stations:
        return np.empty(0), np.empty(0)
    return np.concatenate(stations), np.concatenate(offsets)


def _along(road, s, d):
    """(N,) length along the line at each station: the inner side of a bend is shorter."""
    middle = (s[1:] + s[:-1]) / 2
    rate = np.maximum(1.0 - road.curvature(middle) * (d[1:] + d[:-1]) / 2, 0.1)
    return np.r_[0.0, np.cumsum(np.maximum(np.diff(s), 1e-6) * rate)]
