"""What the scanners could see: lines of sight, and whether their view ends a little above and below the horizon, as that of a many-beam head does."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...survey.blocks import DEFAULT_SENSOR_HEIGHT

if TYPE_CHECKING:
    from ...survey.open_survey import Survey

VIEW_SAMPLE_LENGTH, VIEW_SAMPLES = 4.0, 25   # m of road, and number, of the windows of each road in which the highest view is looked for
LEAST_RANGE = 3.0          # m from the scanner: nearer, a centimetre turns the line of sight too much
HIGHEST_SHARE = 0.999      # of the lines of sight by their slope: single points astray lie above, and as few below the steepest
LEVEL_VIEW = 0.10          # m per m: heads of many beams see up to 0.03 (+2 degrees, Velodyne HDL-64E), and the vehicle tilts; mirrors see all round
STEEPEST_VIEW = 0.70       # m per m down: such heads see 0.46 (-25 degrees) or 0.58 (-30), mirrors 0.9 and more beside the vehicle


def lines_of_sight(survey: Survey, road: int, number: int, s: np.ndarray, d: np.ndarray, h: np.ndarray,
                   time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal vectors from points of a pass to the scanner, and how much higher the scanner is.

    Parameters
    ----------
    survey : Survey
    road, number : of the road and of the pass
    s, d, h : (N,) m, station, offset, and height above the road
    time : (N,) s

    Returns
    -------
    (2, N) m ahead and left along the road, and (N,) m
    """
    driven, line = survey.frame.passes[number], survey.frame.road(road)
    x, y = line.to_map(s, d)
    eye_x, eye_y = driven.at(time, "x", "y") if survey.frame.has_time else line.to_map(s, driven.at_station(s)[0])
    heading = line.heading(s)
    ahead, left = np.cos(heading), np.sin(heading)
    dx, dy = eye_x - x, eye_y - y
    return np.stack([dx * ahead + dy * left, dy * ahead - dx * left]), survey.sensor_height.get(number, DEFAULT_SENSOR_HEIGHT) - h


def level_views(survey: Survey) -> dict[int, float]:
    """The passes whose scanner sees hardly higher than it rides, so that it does not show how high anything is that is as high.

    In open country nothing stands that a mirror could see above it. That its view ends is told by the ground beside the vehicle, which only a
    mirror sees; without times, which tell where the scanner was, nothing high is taken for a view that ends.

    Parameters
    ----------
    survey : Survey

    Returns
    -------
    {number of the pass: m above the road, height of its scanner}
    """
    slopes: dict[int, list[np.ndarray]] = {}
    far: dict[int, list[np.ndarray]] = {}
    for road in survey.store.roads():
        first, last = survey.store.span(road)
        for start in np.linspace(first, max(last - VIEW_SAMPLE_LENGTH, first), VIEW_SAMPLES):
            points = survey.window(road, start, start + VIEW_SAMPLE_LENGTH)
            h = points.z - survey.road_height(road, points.s)
            for number in np.unique(points.pass_number).tolist():
                own = points.pass_number == number
                across, up = lines_of_sight(survey, road, number, points.s[own], points.d[own], h[own], points.time[own])
                away = np.hypot(*across)
                slope = -up / np.maximum(away, 1e-3)
                slopes.setdefault(number, []).append(slope)
                far.setdefault(number, []).append(slope[away > LEAST_RANGE])
    return {number: float(survey.sensor_height.get(number, DEFAULT_SENSOR_HEIGHT)) for number in slopes if _is_level(
        np.concatenate(far[number]), np.concatenate(slopes[number]), survey.frame.has_time)}


def _is_level(far, all_slopes, has_time):
    """Whether slopes of lines of sight to what is far, and to everything, end a little above and below the horizon."""
    if not len(far) or np.quantile(far, HIGHEST_SHARE) >= LEVEL_VIEW:
        return False
    return not has_time or np.quantile(all_slopes, 1.0 - HIGHEST_SHARE) > -STEEPEST_VIEW
