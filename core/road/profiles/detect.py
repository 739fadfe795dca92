"""Curb points: where the road ends at a raised edge, nearest to the driven track on each side."""

from __future__ import annotations

from collections import defaultdict
from contextlib import closing
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter1d

from ...common.features import HEIGHT, OFFSET, PASS, ROAD, SIDE, STATION, Features
from ...common.parallel import ordered_map
from ...common.progress import Progress
from ...lazy import shapely
from ...survey.open_survey import Survey
from ..common.corners import CurbSteps
from ..common.curb_limits import CurbSettings
from ..common.curb_points import CurbPoints
from ..common.decimation import PointDecimation
from ..common.occlusion import OcclusionGrid
from ..common.pseudo_scanlines import widened
from ..common.side_curbs import Search, Section, merged_passes
from ..common.sides import SIDE_SIGNS, OutermostTrack, expected_height, side_profiles, work_sections
from ..surface.ground_grid import is_thin
from ..weights import CURBS, PROFILE
from .steps import beside, find_averaged_steps, find_steps

# derived: nats per m of road; the curb may be at any one of so many places across, and goes on for so long
LEAST_EVIDENCE = np.log(CURBS.max_curb_offset / PROFILE.min_step_spacing) / CURBS.min_curb_length


def tell_points(points: CurbPoints, progress: Progress) -> None:
    """Say in the log how many curb points there are."""
    measured, hidden = (np.count_nonzero(points.status == status) for status in ("measured", "occluded"))
    progress.info(f"Curb points: {measured:,} measured, {hidden:,} hidden by something in front.")


def profiles_of(decimation: PointDecimation, settings: CurbSettings) -> Search:
    """The profiles of all roads."""
    survey = decimation.survey
    spans = {road: survey.store.span(road) for road in survey.store.roads()}
    return Search.of(spans, survey.frame, settings.profile_width, settings.limits, settings.block_length)


def steps_of_section(decimation: PointDecimation, item: Section, settings: CurbSettings) -> tuple[dict[str, CurbSteps], dict[str, OcclusionGrid]]:
    """The phase of profiles: steps in one section of a road, where the scanner is noisy or the cloud thin on several profiles together.

    Returns
        steps : side -> CurbSteps, passes merged
        occlusion : side -> OcclusionGrid of these profiles
    """
    (_, road, *ends), width = item, decimation.width
    section = ends[0], ends[1]
    around = max(CURBS.spread_profiles, int(np.ceil(PROFILE.averaging_length / width)))
    tracks = {side: OutermostTrack(decimation.survey.frame, road, sign) for side, sign in SIDE_SIGNS.items()}
    occlusion = {side: OcclusionGrid(width, section[0], section[1] - section[0], CURBS.max_curb_offset) for side in SIDE_SIGNS}
    steps_by_side: defaultdict[str, list[CurbSteps]] = defaultdict(list)
    wide = section[0] - around, section[1] + around
    limit = None if decimation.mostly_uneven(road, sum(section) // 2) else CURBS.points_per_level_cell
    profiles: Any = list(side_profiles(decimation, road, wide, tracks, settings, limit))
    full = {side for side, _, _, lines in profiles if not is_thin(lines.part(*section).count, width, lines.spacing, CURBS.thin_density)}
    # averages need every point
    if limit and any((lines.part(*section).spread > CURBS.noisy_share * settings.limits.clear_height).any() for *_, lines in profiles):
        profiles = side_profiles(decimation, road, wide, tracks, settings, points_per_cell=None)
    for side, _, (u, s, h), lines in profiles:
        occlusion[side].add_points(u, s, h, section, lines.part(*section))
        steps = _steps_by_noise(lines, section, settings, limit is None, side not in full)
        steps_by_side[side].append(steps[steps.u > tracks[side](steps.s) + PROFILE.min_track_distance])
    return {side: merged_passes(steps) for side, steps in steps_by_side.items()}, occlusion


def _steps_by_noise(lines, section, settings, overgrown, thin):
    """Steps of a section's profiles: on each profile alone, averaged with its neighbours where noise would hide a curb, or in wider ones.

    overgrown : is it the scanner that is noisy, so that curbs before plants are looked for, and not a meadow that is rough?
    thin : has even the road beside the track so few points that several profiles must be looked at together?
    """
    section_lines = lines.part(*section)
    limits = settings.limits
    noisy = section_lines.spread > CURBS.noisy_share * limits.clear_height
    steps = find_steps(section_lines, CURBS.low_curb_share * limits.least_height, settings.max_height)
    if thin and not noisy.all():
        steps = _with_wider_profiles(steps, lines, section, settings)
    if not noisy.any():
        return steps
    rows, around, parts = np.flatnonzero(noisy), section[0] - lines.first, [steps[~noisy[steps.profile - section[0]]]]
    for run in np.split(rows, np.flatnonzero(np.diff(rows) > 2 * around) + 1):
        first, last = section[0] + run[[0, -1]] + [0, 1]
        averaged = find_averaged_steps(lines.part(first - around, last + around), CURBS.low_curb_share * limits.clear_height, settings.max_height,
                                       settings.layer_jump, overgrown)
        averaged = averaged[(averaged.profile >= first) & (averaged.profile < last)]
        parts.append(averaged[noisy[averaged.profile - section[0]]])
    return CurbSteps.join(parts)


def _with_wider_profiles(steps, lines, section, settings):
    """Also the steps that more and more profiles together show, each where fewer of them hold few points and show none."""
    points, count = uniform_filter1d(lines.count.astype(float), round(CURBS.thin_width / lines.spacing), mode="constant"), 1
    for reach in PROFILE.wider_profiles:
        # in as many profiles as were looked at together before
        few = count * uniform_filter1d(points, count, axis=0, mode="nearest") < CURBS.thin_density * lines.width * lines.spacing
        count, (first, last) = 2 * reach + 1, (section[0] - reach, section[1] + reach)
        around = widened(lines.part(first, last), reach, settings.layer_jump, few[first - lines.first:last - lines.first])
        more = find_steps(around.part(*section), CURBS.low_curb_share * settings.limits.least_height,
                          settings.max_height, LEAST_EVIDENCE * count * lines.width)
        off = more.s - (more.profile + 0.5) * lines.width
        # a face in one half of a profile alone begins or ends there
        whole = np.abs(off) <= 0.25 * count * lines.width
        more = replace(more, s=more.s - off, u=more.u - more.skew * off, support=np.maximum(more.support // count, 1))[whole]
        steps = CurbSteps.join([steps, more[~beside(more, steps)]])
    return steps


# The principal points of every profile as a layer: the ground on which curbs are looked for.

PRINCIPAL_POINTS = [ROAD, PASS, SIDE, STATION, OFFSET, HEIGHT]


def find_principal_points(survey: Survey, settings: CurbSettings, progress: Progress = Progress()) -> Features:
    """One point per occupied cell of every profile.

    Returns Features PRINCIPAL_POINTS: PointZ at the middle of the cell, in map coordinates; `height_m` is
    the height above the expected road
    """
    def work(item):
        road, section = item
        tracks = {side: OutermostTrack(survey.frame, road, sign) for side, sign in SIDE_SIGNS.items()}
        parts = []
        for side, number, _, lines in side_profiles(decimation, road, section, tracks, settings):
            profile, cell = np.nonzero(np.isfinite(lines.high))
            s, d, h = (lines.first + profile + 0.5) * lines.width, SIDE_SIGNS[side] * lines.offset(cell), lines.high[profile, cell]
            rows = [{"road": road, "pass": number, "side": side, "station_m": station, "offset_m": offset, "height_m": height}
                    for station, offset, height in zip(s.tolist(), d.tolist(), h.tolist())]
            parts.append((shapely.points(np.c_[survey.frame.to_map(road, s, d, h + expected_height(survey, road, s))]), rows))
        return parts

    features = Features("PointZ", list(PRINCIPAL_POINTS), crs=survey.crs)
    sections = [(road, section) for road in survey.store.roads() for section in work_sections(survey, road, settings.profile_width)]
    with closing(PointDecimation(survey, settings.profile_width, settings.point_spacing)) as decimation:
        for parts in ordered_map(work, sections, progress):
            for places, rows in parts:
                features.geometries += list(places)
                features.rows += rows
    return features
