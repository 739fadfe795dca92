"""Cross-sections of a road: width, crossfall, grade, ruts, curbs and clearance at fixed stations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely
from scipy import ndimage

from ...core.common.errors import RoadExtractionError
from ...core.common.features import CROSS_SECTIONS, Features
from ...core.common.parallel import ordered_map
from ...core.common.progress import Progress
from ...core.common.texts import told, word
from ...core.countries.catalogue import SectionLimits, country
from ...core.curves.robust import MAD_TO_SIGMA
from ...core.survey.frame.road_frame import RoadFrame
from ...core.survey.store.records import Points
from ...core.survey.survey import Survey
from .borders import BorderLayers, CrossSectionSettings, RoadBorders, Strip
from .surface_grid import CROSS_CELL, SLICE_LENGTH, HeightErrors, height_errors, joined_heights, largest_noise, overlaps_of, rut_depths, surface_grid

STRETCH = 10.0               # m of road about a section from which grade and ruts are measured; shorter where the interval is
READ_BESIDE = 1.0                 # m beyond the borders that are read too, for the curbs' tops
BORDER_MARGIN = 0.15         # m inside a border that belong to paint's edge, gutter or curb face
MIN_SURFACE_SEEN = 0.5       # share of a strip's cells that must be seen for its crossfall
MAX_FROM_SURFACE = 0.08      # m from the plane through a lane beyond which a cell is no road: more than any rut
CURB_INSIDE, CURB_OUTSIDE = (0.05, 0.45), (0.10, 0.35)  # m from the edge, where road and curb top are measured
MIN_CURB_CELLS = 3           # of each of the two
AVERAGED_SLICES = (1, 2, 5, 10)  # slices that one profile for rut depths is averaged over, as few as will do
QUIET_PROFILE = 0.0015       # m of noise under the straight edge at which no more slices are averaged
MAX_RUT_CORRECTION = 0.005   # m of noise under the straight edge beyond which a rut depth says nothing
UNCHECKED_ROLL = np.tan(np.radians(0.05))  # m/m: what boresight and navigation of a mapping system leave, where opposite passes do not tell
CHECKED_ROLL = 0.0003        # m/m: the same where they do, see surface_grid.TILT_SIGMA
STEEPEST_MIDDLE = 0.15       # m/m that the carriageway may run oblique to the driven line
LEAST_STRETCHED = 0.3        # m along a strip for each m of station, where a bend is tightest


@dataclass(frozen=True)
class _StripMeasures:
    """What was measured of a strip; NaN where it could not be. Left and right are seen along the road."""

    strip: Strip
    crossfall: float   # crossfall, crossfall_sigma: m/m, positive where the road falls to the right
    crossfall_sigma: float
    grade: float   # m/m, positive where it climbs along the road
    ruts: tuple[float, float]   # (right, left) m
    curbs: tuple[float, float]   # (right, left) m, of the carriageway alone
    clearance: float   # m
    seen: float   # share of its width that was seen


@dataclass(frozen=True)
class _RoadSection:
    road: int   # road, station: where
    station: float
    heading: float   # tangent of the angle between the carriageway and the road's reference line, by which widths across are shortened
    d: np.ndarray   # d, z: (J,) offset and local height of the surface, m; NaN where it was not seen
    z: np.ndarray
    parts: list[_StripMeasures]   # the carriageway, then its lanes from right to left


@dataclass
class RoadSections:
    sections: list[_RoadSection]   # in order of road and station
    errors: dict[int, HeightErrors]   # {road: HeightErrors} between passes and scanners
    frame: RoadFrame   # frame, crs, settings: what they were made with
    crs: str
    settings: CrossSectionSettings
    without_ruts: int = 0   # number of lanes whose points are too noisy for rut depths
    notes: list[str] = field(default_factory=list)


def measure_cross_sections(survey: Survey, layers: BorderLayers = BorderLayers(), settings: CrossSectionSettings = CrossSectionSettings(),
                           progress: Progress = Progress()) -> RoadSections:
    """Measure sections across every road of a survey, opened with enough height above the road for the clearance.

    layers : any may be missing; without edges and lines a lane of the country's usual width about the track is measured
    Raises RoadExtractionError if no section lies on the survey.
    """
    borders = RoadBorders(layers, survey.frame, country(settings.country))
    stretch = min(settings.interval, STRETCH)
    stations = [(road, float(s)) for road in survey.store.roads() for s in _stations(survey, road, settings.interval)]
    if not stations:
        raise RoadExtractionError(
            f"No section lies on the road: it is shorter than the interval of {settings.interval:g} m. Choose a smaller interval.")
    errors = {}
    roads = survey.store.roads()
    for k, road in enumerate(roads):
        part = progress.part(0.4 * k / len(roads), 0.4 * (k + 1) / len(roads))
        errors[road] = _height_errors(survey, road, [s for number, s in stations if number == road], borders, stretch, part)
    result = RoadSections([], errors, survey.frame, survey.crs, settings)

    def measure(place):
        return _section(survey, *place, borders, errors[place[0]], settings.interval, stretch)

    for section, noisy in ordered_map(measure, stations, progress.part(0.4, 1.0)):
        result.without_ruts += noisy
        if section is not None:
            result.sections.append(section)
    if not result.sections:
        raise RoadExtractionError("No section saw a carriageway: the layers given lie on none of the driven roads. Choose those of this survey.")
    note = " At the others the layers do not tell where the carriageway ends, or too little of it was seen."
    progress.info(f"Cross-sections measured at {len(result.sections)} of {len(stations)} stations.{note * (len(result.sections) < len(stations))}")
    _say(result, progress)
    return result


def _stations(survey, road, interval):
    """Whole multiples of the interval along the driven part of a road where points are."""
    first, last = survey.store.span(road)
    first, last = max(first, 0.0), min(last, survey.frame.road(road).length)
    return np.arange(np.ceil(first / interval - 1e-9), np.floor(last / interval + 1e-9) + 1) * interval


def _reach(strips):
    """(right, left) offsets within which the surface of a section is read."""
    return min(strip.right for strip in strips) - READ_BESIDE, max(strip.left for strip in strips) + READ_BESIDE


def _grid(survey, road, s, borders, stretch):
    """The carriageway, its lanes and the surface about a section; None where no layer says where the carriageway is."""
    strips = borders.at(road, s)
    if strips is None:
        return None
    carriageway, lanes = strips
    slices = max(int(round(stretch / SLICE_LENGTH)), 1)
    return carriageway, lanes, surface_grid(survey, road, s - 0.5 * slices * SLICE_LENGTH, slices, _reach([carriageway, *lanes]))


def _height_errors(survey: Survey, road: int, stations: list[float], borders: RoadBorders, stretch: float, progress: Progress) -> HeightErrors:
    """The errors between the passes and scanners over a road; nothing is read where there is but one."""
    if len(survey.frame.passes_of(road)) * len(survey.scanners) < 2:
        return HeightErrors()

    def overlaps(window):
        result = _grid(survey, road, stations[window], borders, stretch)
        return [] if result is None else overlaps_of(result[2], window)

    result = [overlap for window_overlaps in ordered_map(overlaps, range(len(stations)), progress) for overlap in window_overlaps]
    return height_errors(result, survey.frame.passes)


def _section(survey, road, s, borders, errors, interval, stretch):
    """(_RoadSection, lanes without ruts); None where the road was not seen."""
    measured = _grid(survey, road, s, borders, stretch)
    if measured is None:
        return None, 0
    carriageway, lanes, grid = measured
    heights, sigma = joined_heights(grid, errors, survey.frame)
    whole = _plane(grid, heights, carriageway)
    if whole is None:
        return None, 0
    heading = _heading(survey, borders, road, s, carriageway)
    level = _level(grid, heights, whole)
    clearances = _clearances(survey, road, s, interval, (grid.d, level), [carriageway, *lanes])
    noisy, parts = 0, []
    rolled = CHECKED_ROLL if errors.opposite else UNCHECKED_ROLL
    for strip, clearance in zip([carriageway, *lanes], clearances):
        plane = whole if strip is carriageway else _plane(grid, heights, strip)
        inside = (grid.d > strip.right + BORDER_MARGIN) & (grid.d < strip.left - BORDER_MARGIN)
        share = float(np.isfinite(heights[:, inside]).mean()) if inside.any() else 0.0
        ruts = np.nan, np.nan
        if strip.lane and plane is not None:
            profiles, noise = _quiet_profiles(grid, np.where(np.abs(plane.residual) < MAX_FROM_SURFACE, heights, np.nan), sigma, inside, plane.along)
            noisy += not len(noise)
            depths = rut_depths(grid.d, profiles, (strip.right, strip.left), (carriageway.right + BORDER_MARGIN,
                                carriageway.left - BORDER_MARGIN), noise)
            ruts = _median(depths[0]), _median(depths[1])
        across, along = (np.nan, np.nan) if plane is None or share < MIN_SURFACE_SEEN else _falls(survey, road, s, grid, plane, strip, heading)
        parts.append(_StripMeasures(
            strip, across, np.nan if plane is None or np.isnan(across) else float(np.hypot(plane.sigma, rolled)), along, ruts,
            _curbs(grid.d, level, strip) if not strip.lane else (np.nan, np.nan), clearance, share))
    inside = (grid.d > carriageway.right - READ_BESIDE) & (grid.d < carriageway.left + READ_BESIDE)
    z = level[inside] + grid.line(np.array([s]))[0]
    return _RoadSection(road, s, heading, grid.d[inside], z, parts), noisy


@dataclass(frozen=True)
class _Plane:
    """The plane through a strip: slopes across and along, sigma of the former, and (I, J) what the surface lies above it."""

    across: float
    along: float
    sigma: float
    residual: np.ndarray


def _plane(grid, heights, strip):
    """The robust plane through the surface within a strip; None where too little was seen."""
    inside = (grid.d > strip.right + BORDER_MARGIN) & (grid.d < strip.left - BORDER_MARGIN)
    rows, columns = np.nonzero(np.isfinite(heights) & inside)
    if len(rows) < 3 * SLICE_LENGTH / CROSS_CELL or np.ptp(columns) * CROSS_CELL < MIN_SURFACE_SEEN * strip.width:
        return None
    d, s, h = grid.d[columns], grid.s[rows], heights[rows, columns]
    middle = 0.5 * (strip.right + strip.left)
    design = np.c_[np.ones(len(d)), d - middle, s - s.mean()]
    if np.ptp(rows) == 0:
        design = design[:, :2]
    weight, x = np.ones(len(d)), np.zeros(design.shape[1])
    for _ in range(8):
        x = np.linalg.lstsq(design * np.sqrt(weight)[:, None], h * np.sqrt(weight), rcond=None)[0]
        residual = h - design @ x
        scale = max(2.0 * MAD_TO_SIGMA * float(np.median(np.abs(residual))), 0.003)
        weight = 1.0 / (1.0 + (residual / scale) ** 2)
    # profiles repeat along the road: what the surface leaves of a line across counts once, not once for every slice
    sigma = MAD_TO_SIGMA * float(np.median(np.abs(residual))) * np.sqrt(12.0) / (strip.width * np.sqrt(max(len(np.unique(columns)), 1)))
    along = float(x[2]) if len(x) > 2 else 0.0
    fitted = x[0] + x[1] * (grid.d - middle) + along * (grid.s - s.mean())[:, None]
    return _Plane(float(x[1]), along, sigma, heights - fitted)


def _level(grid, heights, plane):
    """(J,) the profile of the stretch at its middle station, by the plane through the carriageway; NaN where no slice saw it."""
    level = heights - plane.along * (grid.s - grid.s.mean())[:, None]
    profile = np.full(heights.shape[1], np.nan)
    columns = np.isfinite(level).any(axis=0)
    profile[columns] = np.nanmedian(level[:, columns], axis=0)
    return profile


def _clearances(survey, road, s, interval, profile, strips):
    """(N,) heights of the lowest thing above N strips within the interval, NaN where there is none, read in short stretches."""
    lowest = np.full(len(strips), np.nan)
    finite = np.isfinite(profile[1])
    pieces = max(int(np.ceil(interval / STRETCH)), 1)
    ends = s + interval * (np.arange(pieces + 1) / pieces - 0.5)
    right, left = min(strip.right for strip in strips) + OVERHEAD_INSIDE, max(strip.left for strip in strips) - OVERHEAD_INSIDE

    def read(start, end):
        points = survey.window(road, start, end)
        d = points.d
        points = points[np.flatnonzero((d > right) & (d < left))]
        nodes = np.linspace(start, end, max(int(round((end - start) / SLICE_LENGTH)), 1) + 1)
        level = np.interp(points.s, nodes, survey.road_height(road, nodes)) + np.interp(points.d, profile[0][finite], profile[1][finite])
        return points, points.z - level

    for start, end in zip(ends[:-1], ends[1:]):
        points, above = read(start, end)
        clear = _clear_of(points, above, strips)
        if np.nanmin(clear, initial=np.inf) < HIGHEST_VEHICLE:
            points, above = read(start - VEHICLE_REACH, end + VEHICLE_REACH)
            kept = np.flatnonzero((points.s >= start) & (points.s < end) & ~_on_vehicles(points.s, points.d, above))
            clear = _clear_of(points[kept], above[kept], strips)
        lowest = np.fmin(lowest, clear)
    return lowest


def _clear_of(points, above, strips):
    """(N,) heights of the lowest thing above N strips, NaN where there is none."""
    return np.array([_clear_height(points, above, strip.right, strip.left) for strip in strips])


def _curbs(d, profile, strip):
    """(right, left) heights of the curbs: the ground just outside the edge above the road's own, continued to the edge."""
    heights = []
    for edge, outward, is_curb in ((strip.right, -1.0, strip.curbs[0]), (strip.left, 1.0, strip.curbs[1])):
        u = outward * (d - edge)
        road = np.isfinite(profile) & (u < -CURB_INSIDE[0]) & (u > -CURB_INSIDE[1])
        top = np.isfinite(profile) & (u > CURB_OUTSIDE[0]) & (u < CURB_OUTSIDE[1])
        if not is_curb or min(road.sum(), top.sum()) < MIN_CURB_CELLS:
            heights.append(np.nan)
            continue
        slope, level = np.polyfit(u[road], profile[road], 1)
        heights.append(float(np.median(profile[top]) - level))
    return heights[0], heights[1]


def _heading(survey, borders, road, s, carriageway):
    """Tangent of the angle between the carriageway and the reference line: what most of its borders and those of its lanes move across."""
    places = s + STRETCH * np.array([-0.5, -0.25, 0.0, 0.25, 0.5])
    crossed = [(station, np.unique([d for strip in [strips[0], *strips[1]] for d in (strip.right, strip.left)]))
               for station, strips in ((station, borders.at(road, float(station))) for station in places) if strips is not None]
    (first, before), (last, after) = crossed[0], crossed[-1]
    across = (after[np.abs(after[:, None] - before).argmin(axis=0)] - before) / max(last - first, 1e-9)
    # where a border begins or ends another one is nearest, and nothing turns
    oblique = across[np.abs(across) < STEEPEST_MIDDLE]
    return float(np.median(oblique)) / _stretched(survey, road, s, carriageway) if len(oblique) else 0.0


def _stretched(survey, road, s, strip):
    """m along a strip's middle for each m of station: less on the inner side of a bend, more on the outer one."""
    line = survey.frame.road(road)
    bend = line.curvature(np.clip(s + STRETCH * np.linspace(-0.5, 0.5, 11), 0.0, line.length))
    return max(1.0 - 0.5 * (strip.right + strip.left) * float(np.mean(bend)), LEAST_STRETCHED)


def _falls(survey, road, s, grid, plane, strip, heading):
    """(fall to the right, climb) of a strip, m/m, across and along the carriageway, which may run oblique to the driven line."""
    along = (plane.along + grid.slope) / _stretched(survey, road, s, strip)
    length = float(np.hypot(1.0, heading))
    return (plane.across - heading * along) / length, (along + heading * plane.across) / length


def _say(sections: RoadSections, progress: Progress) -> None:
    """Log what was estimated, and what cannot be known."""
    for road, errors in sections.errors.items():
        if len(errors.windows):
            progress.info(f"Road {road}: passes and scanners lay up to {1000 * errors.largest_step:.1f} mm above each other (median of the "
                          "sections); such steps and tilts were taken off before anything was measured.")
    unknown = [road for road, errors in sections.errors.items() if not errors.opposite]
    if unknown:
        sections.notes.append(f"Road {', '.join(map(str, unknown))}: no two passes in opposite directions overlap, so an error in roll cannot be "
                              "told from crossfall: 0.1° of roll is 0.17 % of crossfall. Widths, ruts, curbs and clearances do not depend on it. "
                              "Drive the road in both directions to know it.")
    if sections.without_ruts:
        sections.notes.append(f"At {sections.without_ruts} lane sections the points are too few or too noisy for a rut depth: noise alone would "
                              f"show more than {1000 * MAX_RUT_CORRECTION:.0f} mm under the straight edge.")
    if all(part.strip.borders == "track" for section in sections.sections for part in section.parts):
        sections.notes.append("Without road edges, marking lines, driving lines or lanes, a lane of the country's usual width about the driven "
                           "track was measured: its width is no measurement.")
    for note in sections.notes:
        progress.warn(note)


def _quiet_profiles(grid, heights, sigma, inside, along):
    """(K, J) profiles averaged over as few slices as bring their noise down, and (K,) their noise; none where nothing does."""
    level = heights - along * (grid.s - grid.s.mean())[:, None]
    for slices in AVERAGED_SLICES:
        if slices > len(level):
            break
        count = len(level) // slices
        shape = count, slices, level.shape[1]
        finite = np.isfinite(level[:count * slices]).reshape(shape)
        counts = finite.sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            profiles = np.where(finite, level[:count * slices].reshape(shape), 0.0).sum(axis=1) / counts
            noise = np.sqrt(np.where(finite, sigma[:count * slices].reshape(shape) ** 2, 0.0).sum(axis=1)) / counts
        noise = np.array([_median(row) for row in noise[:, inside]])
        limit = QUIET_PROFILE if slices < AVERAGED_SLICES[-1] and 2 * slices <= len(level) else MAX_RUT_CORRECTION
        quiet = largest_noise(noise) < limit
        if quiet.mean() >= 0.5:
            return profiles[quiet], noise[quiet]
    return np.empty((0, level.shape[1])), np.empty(0)


def _median(values):
    """Median without NaN; NaN where there is nothing else."""
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if len(finite) else np.nan


# The height that is free above a strip of road.

LOWEST_OVERHEAD = 2.3     # m: nothing hangs lower over a carriageway, and most vehicles end below it
CLEARANCE_CELL = 0.25     # m, of the columns that are looked through
STANDS_FROM = 0.35        # m above the road: a column with points from here to LOWEST_OVERHEAD stands on the road
STANDING_REACH = 4        # columns about a standing one that belong to the same thing, as a lorry's roof to its flank
MIN_OVERHEAD_POINTS = 4   # of a column within OVERHEAD_DEPTH of its lowest point, so that ghosts and birds do not count
OVERHEAD_DEPTH = 0.15     # m
MIN_OVERHEAD_COLUMNS = 2  # that must agree
OVERHEAD_INSIDE = 0.15             # m by which the strip is narrowed: a pole beside the road is not above it
HIGHEST_VEHICLE = 4.5     # m: 4.0 to 4.3 m are allowed (EU directive 96/53/EC, Japan, China, United States), and loads lie a little higher
BROADEST_VEHICLE = 3.2    # m: 2.6 m are allowed, and mirrors stand out
VEHICLE_REACH = 25.0      # m along the road over which what drives may be seen, drawn out by its own motion
VEHICLE_CELL = 0.25       # m, of the cells that tell what hangs together
LINKED_CELLS = 2, 1, 1    # cells along, across and up by which the points of one thing may lie apart, on either side


def _clear_height(points: Points, h: np.ndarray, right: float, left: float) -> float:
    """Height of the lowest of points, (N,) m above the surface, above a strip between two offsets; NaN where nothing was seen above it."""
    d = points.d
    near = np.flatnonzero((d > right + OVERHEAD_INSIDE) & (d < left - OVERHEAD_INSIDE) & (h > STANDS_FROM))
    if not len(near):
        return np.nan
    s, d, h = points.s[near], d[near], h[near]
    i, j = (np.floor(v / CLEARANCE_CELL).astype(np.int64) for v in (s - s.min(), d - right))
    shape = int(i.max()) + 1, int(j.max()) + 1
    standing = np.zeros(shape, bool)
    low = h < LOWEST_OVERHEAD
    standing[i[low], j[low]] = True
    reach = np.ones((2 * STANDING_REACH + 1,) * 2)
    if standing.any():
        standing = ndimage.binary_dilation(standing, reach)
    free = ~low & ~standing[i, j]
    if not free.any():
        return np.nan
    cell, h = (i * shape[1] + j)[free], h[free]
    order = np.lexsort((h, cell))
    cell, h = cell[order], h[order]
    first = np.flatnonzero(np.r_[True, np.diff(cell) > 0])
    last = np.r_[first[1:], len(cell)] - 1
    needed = first + MIN_OVERHEAD_POINTS - 1
    lowest = h[first]
    solid = needed <= last
    solid[solid] = h[needed[solid]] - lowest[solid] < OVERHEAD_DEPTH
    lowest = np.sort(lowest[solid])
    return float(lowest[MIN_OVERHEAD_COLUMNS - 1]) if len(lowest) >= MIN_OVERHEAD_COLUMNS else np.nan


def _on_vehicles(s: np.ndarray, d: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Which points belong to what stands or drives on the road.

    A vehicle that moves beside the scanner is drawn out, and in places only the upper part of its flank was seen. What hangs together from below
    LOWEST_OVERHEAD and is neither higher nor broader than vehicles may be is taken for one; a deck on a pier is not, for it is broader.
    """
    on_vehicle = np.zeros(len(s), bool)
    standing = np.flatnonzero(h > STANDS_FROM)
    if not len(standing):
        return on_vehicle
    s, d, h = s[standing], d[standing], h[standing]
    cells = tuple(np.floor((v - v.min()) / VEHICLE_CELL).astype(np.int64) for v in (s, d, h))
    filled = np.zeros([int(c.max()) + 1 for c in cells], bool)
    filled[cells] = True
    groups, count = ndimage.label(ndimage.binary_dilation(filled, np.ones([2 * reach + 1 for reach in LINKED_CELLS])), np.ones((3, 3, 3)))
    group = groups[cells]
    lowest, highest = np.full(count + 1, np.inf), np.full(count + 1, -np.inf)
    np.minimum.at(lowest, group, h)
    np.maximum.at(highest, group, h)
    breadth = np.array([0.0, *((across.stop - across.start - 2 * LINKED_CELLS[1]) * VEHICLE_CELL for _, across, _ in
                              ndimage.find_objects(groups))])
    vehicle = (lowest < LOWEST_OVERHEAD) & (highest < HIGHEST_VEHICLE) & (breadth < BROADEST_VEHICLE)
    on_vehicle[standing] = vehicle[group]
    return on_vehicle


# Cross-sections as a layer of lines, one for every lane and carriageway, and as a table.

LINE_TOLERANCE = 0.003   # m of height to which the drawn profile is simplified


def sections_to_features(sections: RoadSections) -> tuple[Features, Features]:
    """The layer CROSS_SECTIONS, and the same rows without geometry as a table.

    A line with Z runs from the left border of every carriageway and lane of every section to the right one; where the surface was not seen it
    is drawn straight between the heights known.
    """
    lines, table = Features("LineStringZ", CROSS_SECTIONS, crs=sections.crs), Features("None", CROSS_SECTIONS, crs=sections.crs)
    limits = sections.settings.limits()
    for number, section in enumerate(sections.sections):
        for part in section.parts:
            row = _row(number, section, part, limits)
            lines.add(_line(section, part, sections.frame), **row)
            table.add(None, **row)
    return lines, table


def exceeded(part: _StripMeasures, width: float, limits: SectionLimits) -> dict[str, str]:
    """{limit that a lane or carriageway does not keep: value, limit and rule}, in a fixed order.

    Crossfall and width are judged of driving lanes, the grade and the clearance of everything; a crossfall where its error does not explain it.
    """
    driven = part.strip.lane > 0 and part.strip.type == "driving"
    fall, unsure = abs(100 * part.crossfall), 2 * 100 * part.crossfall_sigma
    checks = (
        ("rut", "max_rut", driven, 1000 * np.fmax(*part.ruts), 0.0, "{:.1f} > {:.4g} mm"),
        ("crossfall", "max_crossfall", driven, fall, unsure, "{:.2f} > {:.4g} %"),
        ("crossfall", "min_crossfall", driven, fall, unsure, "{:.2f} < {:.4g} %"),
        ("grade", "max_grade", True, abs(100 * part.grade), 0.0, "{:.1f} > {:.4g} %"),
        ("width", "min_width", driven and part.strip.borders != "track", width, 0.0, "{:.2f} < {:.4g} m"),
        ("clearance", "min_clearance", True, part.clearance, 0.0, "{:.2f} < {:.4g} m"),
    )
    reasons = {}
    for name, limit_name, is_judged, value, error, form in checks:
        limit = getattr(limits, limit_name)
        if is_judged and limit is not None and (value - error > limit if limit_name.startswith("max") else value + error < limit):
            reasons[name] = f"{word(name)} {form.format(value, limit)} [{told(limits.rules[limit_name])}]"
    return reasons


def _row(number: int, section: _RoadSection, part: _StripMeasures, limits: SectionLimits) -> dict[str, Any]:
    strip = part.strip
    width = strip.width / float(np.hypot(1.0, section.heading))
    reasons = exceeded(part, width, limits)
    return dict(
        road=section.road, section=number + 1, station_m=section.station, part="lane" if strip.lane else "carriageway",
        lane=strip.lane or None, type=strip.type, direction=strip.direction, offset_m=0.5 * (strip.left + strip.right), width_m=width,
        borders=strip.borders, crossf_pct=100 * part.crossfall, crossf_sig=100 * part.crossfall_sigma, grade_pct=100 * part.grade,
        rut_l_mm=1000 * part.ruts[1], rut_r_mm=1000 * part.ruts[0], curb_l_m=part.curbs[1], curb_r_m=part.curbs[0], clear_m=part.clearance,
        seen_pct=100 * part.seen, exceeds=", ".join(reasons) or None, why="; ".join(reasons.values()) or None)


def _line(section, part, frame):
    """The measured profile between the borders of a strip, from left to right."""
    finite = np.isfinite(section.z)
    inside = finite & (section.d > part.strip.right) & (section.d < part.strip.left)
    d = np.r_[part.strip.right, section.d[inside], part.strip.left]
    z = np.interp(d, section.d[finite], section.z[finite])
    if len(d) > 2:
        d, z = shapely.get_coordinates(shapely.simplify(shapely.linestrings(np.c_[d, z]), LINE_TOLERANCE)).T
    places = frame.to_map(section.road, np.full(len(d), section.station), d, z)
    return shapely.linestrings(np.stack(places, axis=1)[::-1])
