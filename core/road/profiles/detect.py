"""Curb points: where the road ends at a raised edge, nearest to the driven track on each side."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from typing import TYPE_CHECKING, Any

import numpy as np

from ...common.features import HEIGHT, OFFSET, PASS, ROAD, SIDE, STATION, Features
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...execution.phase import Phase
from ..common.corners import CurbSteps
from ..common.curb_limits import CurbSettings
from ..common.curb_points import CurbPoints, curb_points_at
from ..common.decimation import PointDecimation
from ..common.occlusion import OcclusionGrid
from ..common.sides import SIDE_SIGNS, OutermostTrack, expected_height, hidden_points, join_sections, side_profiles, work_sections
from ..common.tracking import SideChains, curb_chains, drop_short_curbs, link_steps, select_along_road, with_pieces_in_line
from ..curb_returns.detect import with_curb_returns
from ..weights import CURBS, PROFILE
from .steps import find_averaged_steps, find_steps

if TYPE_CHECKING:
    from ...survey.frame.road import Road
    from ...survey.open_survey import Survey


def detect_curbs(survey: Survey, settings: CurbSettings = CurbSettings(), progress: Progress = Progress(),
                 include_returns: bool = True, decimation: PointDecimation | None = None,
                 beside: dict[int, dict[str, OcclusionGrid]] | None = None,
                 side_chains: dict[tuple[int, str], SideChains] | None = None) -> CurbPoints:
    """Bottom corners of the curb on each side of every road, one per block.

    Parameters
    ----------
    survey : Survey
    settings : CurbSettings
    progress : Progress
    include_returns : are corners, side streets and islands looked for too?
    decimation : PointDecimation of the survey, where it is used again
    beside : is given what was seen beside each road: number of the road -> side -> OcclusionGrid
    side_chains : is given all chains that were found: (number of the road, side) -> SideChains

    Returns
    -------
    CurbPoints. Those of status `measured` are vertices of the road edge; those of
    status `occluded` lie where the curb is expected and something hides it.
    """
    if decimation is None:
        with closing(PointDecimation(survey, settings.profile_width, settings.point_spacing)) as own:
            return detect_curbs(survey, settings, progress, include_returns, own, beside, side_chains)
    parts, beside, side_chains = [], {} if beside is None else beside, {} if side_chains is None else side_chains
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        part = progress.part(PROFILE.main_curb_progress * i / len(roads), PROFILE.main_curb_progress * (i + 1) / len(roads))
        steps, beside[road] = _steps_of_road(decimation, road, settings, part)
        for side in SIDE_SIGNS:
            if steps[side] is not None and len(steps[side]):
                known = side_chains[road, side] = _chains_of_side(survey, road, steps[side], settings)
                parts.append(_points_of_side(survey, road, side, known, beside[road][side]))
    found = CurbPoints.join(parts, survey.crs)
    measured, main = np.count_nonzero(found.status == "measured"), len(found)
    if include_returns:
        found = with_curb_returns(found, decimation, settings, progress.part(PROFILE.main_curb_progress, 1.0), beside)
    progress.info(f"Curb points: {measured:,} measured, {main - measured:,} hidden by something in front.")
    return found


def _steps_of_road(decimation, road, settings, progress):
    """Steps of each side, passes merged, and what was seen beside the road."""
    survey, width = decimation.survey, decimation.width
    sections = work_sections(survey, road, width)
    first, last = sections[0][0], sections[-1][1]
    occlusion = {side: OcclusionGrid(width, first, last - first, CURBS.max_curb_offset) for side in SIDE_SIGNS}
    phase = Phase(steps_of_section, decimation, (road, settings), lambda section: survey.stretch(road, *(k * width for k in section)),
                  lambda section: survey.store.points_between(road, *(k * width for k in section)), join_sections, CURBS.sections_together)
    parts = {side: [] for side in SIDE_SIGNS}
    for found, beside in decimation.executor.run(phase, sections, progress):
        for side, steps in found.items():
            parts[side].append(steps)
        for side, seen in beside.items():
            occlusion[side].add(seen)
    return {side: CurbSteps.join(parts[side]) if parts[side] else None for side in SIDE_SIGNS}, occlusion


def steps_of_section(decimation: PointDecimation, section: tuple[int, int], road: int,
                     settings: CurbSettings) -> tuple[dict[str, CurbSteps], dict[str, OcclusionGrid]]:
    """The phase of profiles: steps in one section of a road.

    Parameters
    ----------
    decimation : PointDecimation of the survey
    section : (first, last + 1) profile numbers
    road : number of the road
    settings : CurbSettings

    Returns
    -------
    steps : side -> CurbSteps, passes merged
    occlusion : side -> OcclusionGrid of these profiles
    """
    width = decimation.width
    around = max(CURBS.spread_profiles, int(np.ceil(PROFILE.averaging_length / width)))
    tracks = {side: OutermostTrack(decimation.survey.frame, road, sign) for side, sign in SIDE_SIGNS.items()}
    occlusion = {side: OcclusionGrid(width, section[0], section[1] - section[0], CURBS.max_curb_offset) for side in SIDE_SIGNS}
    found: dict[str, list[CurbSteps]] = {side: [] for side in SIDE_SIGNS}
    wide = section[0] - around, section[1] + around
    limit = None if decimation.mostly_uneven(road, sum(section) // 2) else CURBS.points_per_level_cell
    seen: Any = list(side_profiles(decimation, road, wide, tracks, settings, limit))
    # averages need every point
    if limit and any((lines.part(*section).spread > CURBS.noisy_share * settings.limits.clear_height).any() for *_, lines in seen):
        seen = side_profiles(decimation, road, wide, tracks, settings, points_per_cell=None)
    for side, _, (u, s, h), lines in seen:
        occlusion[side].add_points(u, s, h, section, lines.part(*section))
        steps = _steps_by_noise(lines, section, settings, overgrown=limit is None)
        found[side].append(steps[steps.u > tracks[side](steps.s) + PROFILE.min_track_distance])
    return {side: _merge_passes(steps) for side, steps in found.items() if steps}, occlusion


def _steps_by_noise(lines, section, settings, overgrown):
    """Steps of a section's profiles: on each profile alone, or averaged with its neighbours where noise would hide a curb.

    overgrown : is it the scanner that is noisy, so that curbs before plants are looked for, and not a meadow that is rough?
    """
    own = lines.part(*section)
    limits = settings.limits
    noisy = own.spread > CURBS.noisy_share * limits.clear_height
    single = find_steps(own, CURBS.low_curb_share * limits.least_height, settings.max_height)
    if not noisy.any():
        return single
    averaged = find_averaged_steps(lines, CURBS.low_curb_share * limits.clear_height, settings.max_height, settings.layer_jump, overgrown)
    averaged = averaged[(averaged.profile >= section[0]) & (averaged.profile < section[1])]
    return CurbSteps.join([single[~noisy[single.profile - own.first]], averaged[noisy[averaged.profile - own.first]]])


def _merge_passes(found):
    """One step where several passes saw the same one: the mean, weighted by support."""
    steps = CurbSteps.join(found)
    if len(found) < 2 or not len(steps):
        return steps
    order = np.lexsort((steps.u, steps.profile))
    steps = steps[order]
    apart = (np.diff(steps.profile) > 0) | (np.diff(steps.u) > PROFILE.pass_merge_across) | (np.abs(np.diff(steps.h)) > PROFILE.pass_merge_height)
    group = np.r_[0, np.cumsum(apart)]
    weight = np.sqrt(np.maximum(steps.support, 1))
    total = np.bincount(group, weight)
    values = {name: np.bincount(group, weight * getattr(steps, name)) / total
              for name in ("s", "u", "h", "skew", "height", "run", "noise", "scanner_noise")}
    return CurbSteps(profile=steps.profile[np.r_[True, apart]], **values,
                 support=np.bincount(group, steps.support).astype(np.int64),
                 behind=np.bincount(group, steps.behind).astype(np.int64))


def _chains_of_side(survey, road, steps, settings):
    """The SideChains of the steps of one side of one road."""
    bounds = block_bounds(survey.frame.road(road), *survey.store.span(road), settings.block_length)
    chains = curb_chains(steps, link_steps(steps, settings.profile_width), settings.profile_width, settings.limits)
    return SideChains(steps, chains, lambda members, number: _block_points(members, bounds, number))


def _points_of_side(survey, road, side, known, occlusion):
    """Curb points of one side of one road, measured and hidden, in order of station."""
    frame, sign, steps, chains = survey.frame, SIDE_SIGNS[side], known.steps, known.chains
    track = OutermostTrack(frame, road, sign)
    selected = drop_short_curbs(select_along_road(chains, steps, track), chains, steps)
    selected = with_pieces_in_line(selected, chains, steps, lambda s, u: frame.road(road).to_map(s, sign * u))
    rows = [row for number, part in enumerate(selected) for row in known.points(part, number)]
    measured = np.array([(r["s"], r["u"], r["h"]) for r in rows]).reshape(-1, 3)
    rows += hidden_points(measured, occlusion, track)
    rows.sort(key=lambda r: r["s"])
    s, u, h = (np.array([r[name] for r in rows], float) for name in ("s", "u", "h"))
    x, y, z = frame.to_map(road, s, sign * u, h + expected_height(survey, road, s))
    return curb_points_at(frame, road, (x, y, z), [row["fields"] for row in rows], side=side, station=s, offset=sign * u)


def block_bounds(road: Road, start: float, end: float, block_length: float) -> np.ndarray:
    """Stations at which blocks begin and end, counted from station 0.

    Automatic blocks are PROFILE.min_block_length to PROFILE.max_block_length long, so that the road turns no
    more than PROFILE.max_block_turn within one; the length is decided for every 20 m of road.

    Parameters
    ----------
    road : Road
    start, end : m, stations that the blocks cover
    block_length : m, 0 for automatic

    Returns
    -------
    (K,) m, ascending
    """
    bounds = []
    first, last = int(np.floor(start / CURBS.block_section_length)), int(np.ceil(end / CURBS.block_section_length))
    if block_length:
        return np.arange(np.floor(start / block_length), np.ceil(end / block_length) + 1) * block_length
    for k in range(first, last):
        bend = np.abs(road.curvature(np.arange(k * CURBS.block_section_length, (k + 1) * CURBS.block_section_length, 0.5))).max()
        length = np.clip(PROFILE.max_block_turn / max(bend, 1e-9), PROFILE.min_block_length, PROFILE.max_block_length)
        bounds.append(np.linspace(k * CURBS.block_section_length, (k + 1) * CURBS.block_section_length,
                                  int(np.ceil(CURBS.block_section_length / length)) + 1)[:-1])
    return np.r_[np.concatenate(bounds), last * CURBS.block_section_length] if bounds else np.array([start, end])


def _block_points(steps, bounds, chain):
    """One point per block from the steps of a chain: their mean place."""
    if not len(steps):
        return []
    names, member = np.unique(block_numbers(steps, bounds), return_inverse=True)
    n = np.bincount(member)

    def mean(v):
        return np.bincount(member, v) / n

    s, u, h, height = (mean(v) for v in (steps.s, steps.u, steps.h, steps.height))
    residual = np.sqrt(mean((steps.u - np.interp(steps.s, s, u)) ** 2))
    support = np.bincount(member, steps.support)
    return [dict(s=float(s[k]), u=float(u[k]), h=float(h[k]),
                 fields=dict(status="measured", height=round(float(height[k]), 4), chain=chain,
                             residual=round(float(residual[k]), 4), support=int(support[k]))) for k in range(len(names))]


def block_numbers(steps: CurbSteps, bounds: np.ndarray) -> np.ndarray:
    """The block of each step of a chain.

    Blocks in which the curb bends are divided into four, and both ends of a chain are blocks of their own.

    Parameters
    ----------
    steps : M CurbSteps of one chain, by station
    bounds : (K,) m, result of `block_bounds`

    Returns
    -------
    (M,) numbers, ascending along the road
    """
    block = np.searchsorted(bounds, steps.s, side="right")
    names, member = np.unique(block, return_inverse=True)
    n = np.bincount(member)
    ds = steps.s - (np.bincount(member, steps.s) / n)[member]
    du = steps.u - (np.bincount(member, steps.u) / n)[member]
    slope = np.bincount(member, ds * du) / (np.bincount(member, ds * ds) + 1e-3)
    off = np.sqrt(np.bincount(member, (du - slope[member] * ds) ** 2) / n)
    start, length = bounds[names - 1], np.diff(bounds)[np.minimum(names, len(bounds) - 1) - 1]
    quarter = np.clip(np.floor(4 * (steps.s - start[member]) / length[member]), 0, 3).astype(np.int64)
    block = 8 * block + 2 * np.where(off[member] > PROFILE.max_block_bend, quarter, 0)  # even numbers leave odd ones for the ends
    # the ends of a chain keep their own place instead of the middle of their blocks
    if len(steps) > 2 * PROFILE.chain_end_steps:
        block[:PROFILE.chain_end_steps] = block[0] - 1
        block[-PROFILE.chain_end_steps:] = block[-1] + 1
    return block


# The principal points of every profile as a layer: the ground on which curbs are looked for.

PRINCIPAL_POINTS = [ROAD, PASS, SIDE, STATION, OFFSET, HEIGHT]


def find_principal_points(survey: Survey, settings: CurbSettings, progress: Progress = Progress()) -> Features:
    """One point per occupied cell of every profile.

    Parameters
    ----------
    survey : Survey
    settings : CurbSettings
    progress : Progress

    Returns
    -------
    Features PRINCIPAL_POINTS: PointZ at the middle of the cell, in map coordinates; `height_m` is
    the height above the expected road
    """
    import shapely

    found = Features("PointZ", list(PRINCIPAL_POINTS), crs=survey.crs)
    roads = survey.store.roads()
    for i, road in enumerate(roads):
        part = progress.part(i / len(roads), (i + 1) / len(roads))
        for pass_number, side, s, u, h in _points_of_road(survey, road, settings, part):
            d = SIDE_SIGNS[side] * u
            x, y, z = survey.frame.to_map(road, s, d, h + expected_height(survey, road, s))
            found.geometries += list(shapely.points(np.c_[x, y, z]))
            found.rows += [
                {"road": road, "pass": pass_number, "side": side, "station_m": station, "offset_m": offset, "height_m": height}
                for station, offset, height in zip(s.tolist(), d.tolist(), h.tolist())
            ]
    return found


def _points_of_road(survey: Survey, road: int, settings: CurbSettings,
                    progress: Progress) -> Iterator[tuple[int, str, np.ndarray, np.ndarray, np.ndarray]]:
    """(pass, side, stations, outward offsets, heights) of one section and side after the other."""
    tracks = {side: OutermostTrack(survey.frame, road, sign) for side, sign in SIDE_SIGNS.items()}

    def work(section):
        found = []
        for side, number, _, lines in side_profiles(decimation, road, section, tracks, settings):
            profile, cell = np.nonzero(np.isfinite(lines.high))
            stations = (lines.first + profile + 0.5) * lines.width
            found.append((number, side, stations, lines.offset(cell), lines.high[profile, cell]))
        return found

    with closing(PointDecimation(survey, settings.profile_width, settings.point_spacing)) as decimation:
        for results in ordered_map(work, work_sections(survey, road, settings.profile_width), progress):
            yield from results
