"""Lanes followed along the road, from the estimated cross-sections to tracks with offsets at every station, and their tapers."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby

import numpy as np
from scipy.linalg import solveh_banded
from scipy.ndimage import binary_dilation

from ..common.arrays import mask_runs
from ..common.parallel import check_cancelled
from ..countries.catalogue import NEUTRAL
from ..markings.cross_section.beside import BEYOND
from ..markings.cross_section.candidates import STATIONS_OF_CELL, Boundaries
from ..markings.cross_section.estimate import RoadEstimate, lane_spans
from ..markings.cross_section.sections import STATION_STEP
from ..markings.cross_section.sequence import beside_island, lane_places
from ..markings.cross_section.weights import BARE, DASHED, EDGE_LINE, SAME_LANE, SURFACE_END, UNPAINTED
from ..markings.weights import ROADS
from ..road.common.pseudo_scanlines import expand_ranges
from .lane_track import BRIDGED, INFERRED, MEASURED, LaneTrack, spans_of
from .weights import ALIGNMENT, TRACKS


def estimated_lanes(boundaries: Boundaries, estimate: RoadEstimate, lane_width: float, line_distance: float = 0.0) -> list[LaneTrack]:
    """The lanes of a road, each from where it begins to where it ends or its interval has no lanes.

    `lane_width` : m, of a lane beside which only one line is painted; `line_distance` : m from that line to its middle, 0 for half of its width.
    """
    open_tracks: list[list[LaneTrack]] = []
    closed: list[list[LaneTrack]] = []
    parts_of: dict[int, list[LaneTrack]] = {}
    for interval, part in _parts(boundaries, estimate, lane_width, line_distance):
        parts_of.setdefault(interval, []).append(part)
    for i, first in enumerate(estimate.candidates.first.tolist()):
        parts = parts_of.get(i, [])
        follows = _followed(open_tracks, parts, first)
        closed += [lane for k, lane in enumerate(open_tracks) if k not in follows.values()]
        open_tracks = [[*open_tracks[follows[k]], part] if k in follows else [part] for k, part in enumerate(parts)]
        check_cancelled()
    tracks = [_as_elsewhere(_without_steps(lane) if len(lane) > 1 else lane[0], boundaries, estimate) for lane in closed + open_tracks]
    return [_to_its_ends(track, boundaries) for track in tracks]


def _as_elsewhere(track, boundaries, estimate):
    """The track moved to where it was driven as along most of it, where one painted border leads far aside.

    That border is then of what opens or closes beside the lane, which goes on beside the other one, as wide as elsewhere. This is as rare as a border
    without a line, but a drive farther off the middle than vehicles scatter is rarer.
    """
    weights, sides = estimate.weights, np.stack([track.left, track.right])
    beside, count = _driven_beside(track, boundaries.s, estimate)
    room, painted = track.width - np.median(track.width), (sides >= 0).all(axis=0) & boundaries.bounding[sides].all(axis=0)
    unlike, usual = painted & (np.abs(room) > ALIGNMENT.max_parallel_deviation), (count > 0) & (np.abs(room) < SAME_LANE)
    share = np.zeros(len(track))
    beside -= np.median(beside[usual]) if usual.any() else beside
    for first, end in mask_runs(unlike):
        if track.width[first:end].max() > NEUTRAL.widest_lane:
            middle = np.exp(weights.bare[EDGE_LINE] - 0.5 * (beside[first:end] / weights.track_sigma) ** 2)
            share[first:end] = (count[first:end] > 0) / (1 + middle + weights.odd_width * weights.track_sigma / weights.driven_sigma)
    moved = share * np.clip(beside, -np.abs(room) / 2, np.abs(room) / 2)
    return replace(track, d=track.d + moved, width=track.width - share * room, aside=track.aside + moved)


def _to_its_ends(track, boundaries):
    """The track up to where its painted borders begin and end: intervals are coarser than stations."""
    track = _within_its_borders(track, boundaries)
    for head in (True, False):
        tip = 0 if head else -1
        rows = np.array([int(track.left[tip]), int(track.right[tip])])
        known = rows >= 0
        end = track.first if head else track.last
        if not known.any() or not boundaries.painted[rows[known]].all() or np.isnan(boundaries.d[rows[known], end]).any():
            continue
        reach, last = STATIONS_OF_CELL, len(boundaries.s) - 1
        ahead = np.arange(end - 1, max(end - reach, 0) - 1, -1) if head else np.arange(end + 1, min(end + reach, last) + 1)
        bounded = np.isfinite(boundaries.d[rows[known][:, None], ahead]).all(axis=0)
        ahead = ahead[:len(bounded) if bounded.all() else int(np.argmin(bounded))]
        if len(ahead):
            ahead = np.sort(ahead)
            # one painted border alone leads the lane on as it leads it up to there
            d, width = (np.full(len(ahead), value) for value in track.at(end))
            if known.all():
                d_left, d_right = boundaries.d[rows[:, None], ahead]
                d, width = (d_left + d_right) / 2, d_left - d_right
            else:
                d = d + boundaries.d[rows[known][0], ahead] - boundaries.d[rows[known][0], end]
            more = track.stretched(int(ahead[0]), d, width, tip)
            track = LaneTrack.joined([more, track] if head else [track, more])
    return track


def _within_its_borders(track, boundaries):
    """The track less the stations at its ends where a painted border has ended more than a station before."""
    columns, bounded = track.stations, np.ones(len(track), bool)
    for rows in (track.left, track.right):
        bounding = (rows >= 0) & boundaries.bounding[rows]
        bounded &= ~bounding | np.isfinite(boundaries.d[rows, columns])
    present = np.flatnonzero(binary_dilation(bounded))
    return track.part(present[0], present[-1] + 1) if len(present) else track


def beyond_paint(tracks: list[LaneTrack], boundaries: Boundaries, estimate: RoadEstimate) -> list[LaneTrack]:
    """The same lanes, each on from where its paint ends, as at a stop line, up to where what bounds the road beside it begins to move aside.

    That is the mouth of a junction. On the way a lane that was driven goes on as most of its borders and the drive do, another one keeps its share
    of the room between the nearest borders that go on. Either may change by the double of SAME_LANE: half of that is what its middle is off by
    then. Where anything begins on the lane, or between the borders of one that nobody drove, such as an island, it ends. A few metres are worth it
    only where the road ends with them.
    """
    spans, result = spans_of(tracks), list(tracks)
    least, reach = (int(length / STATION_STEP) for length in (ALIGNMENT.min_status_length, ROADS.shortest_bare))
    for number in range(len(tracks)):
        for head in (True, False):
            track = result[number]
            end, step = (track.first, -1) if head else (track.last, 1)
            ahead = np.arange(end, end + step * (reach + 1), step)
            ahead = ahead[(ahead >= 0) & (ahead < len(boundaries.s))]
            d, width = track.at(end)
            course = _beside_borders(boundaries, ahead, d, width, _driven_on(estimate, boundaries.s, ahead, d, width, track.direction), least)
            near = [result[k] for k in spans.near(end - 2 * reach, end + 2 * reach).tolist() if k != number]
            taken = [any(abs(other.at(k)[0] - place) < (other.at(k)[1] + width) / 2 - SAME_LANE for other in near)
                     for k, place in zip(ahead.tolist(), course.tolist())]
            count = taken.index(True) if True in taken else len(taken)
            if count > (1 if ahead[count - 1] in (0, len(boundaries.s) - 1) else least):   # the road ends there
                ahead, course = (values[1:count][::step] for values in (ahead, course))
                unknown = np.full(len(course), -1)
                more = track.stretched(int(ahead[0]), course, np.full(len(course), width), 0 if head else -1)
                more = replace(more, status=np.full(len(course), INFERRED), offset=np.zeros(len(course), bool), left=unknown, right=unknown,
                               probability=TRACKS.bridged_trust * more.probability, confidence=TRACKS.trust_beyond_paint * more.confidence)
                result[number] = LaneTrack.joined([more, track] if head else [track, more])
        check_cancelled()
    return result


def _driven_on(estimate, s, ahead, d, width, direction):
    """(N,) m, how far aside those who drove in a lane at `d` at the first of the stations `ahead` drove at each; NaN beyond, None without any."""
    drives, passes = _drives(ahead, s, estimate, direction)
    drives = drives[(passes < estimate.evidence.own) & (np.abs(drives[:, 0] - d) < width / 2)]
    return (drives - drives[:, :1]).mean(axis=0) if len(drives) else None


def _beside_borders(boundaries, ahead, d, width, driven, least):
    """(N,) m, offsets of a lane at `d` at the stations `ahead`, from the first of them on, as far as what bounds it goes on alike."""
    rows = boundaries.d.spans.near(*sorted((int(ahead[0]), int(ahead[-1]))))
    rows = rows[~SURFACE_END[boundaries.patterns[rows, ahead[0]]]]
    offset = boundaries.d[rows[:, None], ahead]
    beside = offset[:, 0] - d
    goes_on = np.isfinite(offset[:, :least + 1]).all(axis=1)
    sides = [np.flatnonzero((side * beside > width / 2 - SAME_LANE) & goes_on) for side in (1, -1)]
    nearest = np.array([side[np.abs(beside[side]).argmin()] for side in sides if len(side)], int)
    # between two lines that both go on it has ended for another reason
    if len(nearest) < (2 if driven is None else 1) or boundaries.bounding[rows[nearest]].all() \
            and np.abs(beside[nearest]).sum() < width + NEUTRAL.narrowest_lane:
        return np.array([d])
    bounds, begins = offset[nearest], offset[np.isnan(beside)]
    with np.errstate(invalid="ignore"):   # NaN where a border has ended
        if driven is None:
            room = bounds[0] - bounds[1]
            course, moved = bounds[1] + room * (d - bounds[1, 0]) / room[0], np.abs(room - room[0])
            within = (begins < bounds[0]) & (begins > bounds[1])
        else:
            # what most of these have in common: one border may give way to a bay, and a vehicle may turn
            course = d + np.median([*(bounds - bounds[:, :1]), driven], axis=0)
            aside = np.abs(bounds - course) - np.abs(beside[nearest, None])
            moved = np.maximum(aside.max(axis=0), np.abs(aside).min(axis=0))
            within = np.abs(begins - course) < width / 2
        alike = (moved < 2 * SAME_LANE) & ~within.any(axis=0)
    return course[:len(alike) if alike.all() else int(np.argmin(alike))]


def _without_steps(parts):
    """The LaneTracks of one lane, one after the other, as one without steps between them.

    What each place is moved by is small against how sure the place is, and changes along the lane by little but the step where two parts meet. Both
    errors are normal, so the most probable one is a least squares along the lane. A place between lines that are seen is sure, and where both parts
    are nothing is moved for their sake. Where nothing is painted between two lanes, what parts them goes on as before over a long way.
    """
    track = LaneTrack.joined(parts)
    seen, strip = track.status == MEASURED, ~track.offset & ((track.left < 0) | (track.right < 0))
    sigma, reach = np.where(seen, *TRACKS.place_sigma), np.where(strip & ~seen, *TRACKS.place_reach)
    variance = (sigma * STATION_STEP / reach) ** 2   # of what two neighbours are moved by
    weight = 2 / (variance[1:] + variance[:-1])
    joints = np.cumsum([len(part) for part in parts[:-1]])
    weight[joints[seen[joints - 1] & seen[joints]] - 1] = 0.0
    change, step = np.diff([track.d, track.width]), np.zeros((2, len(weight)))
    # a lane goes on there as it does right before and behind
    step[:, joints - 1] = (change[:, np.maximum(joints - 2, 0)] + change[:, np.minimum(joints, len(weight) - 1)]) / 2 - change[:, joints - 1]
    flow = np.pad(weight * step, ((0, 0), (1, 1)))
    diagonal = 1 / sigma**2 + np.append(weight, 0.0) + np.append(0.0, weight)
    moved = solveh_banded(np.stack([diagonal, np.append(-weight, 0.0)]), (flow[:, :-1] - flow[:, 1:]).T, lower=True).T
    return replace(track, d=track.d + moved[0], width=track.width + moved[1], aside=track.aside + moved[0])


def _parts(boundaries, estimate, lane_width, line_distance):
    """(interval, LaneTrack) of the spans of which both borders are known."""
    spans, *borders, made_of = _borders_of(boundaries, estimate)
    if not spans:
        return
    apart, count = np.array([span.beside[BEYOND] >= 0 for span in spans]), np.array([span.count for span in spans])
    some, every, dashed = UNPAINTED[made_of].any(axis=0), UNPAINTED[made_of].all(axis=0), (made_of == DASHED).all(axis=0)
    # one lane has all the room between two borders, and beside an island
    shared = np.where(count > 1, some | dashed, some & ~(apart | every | beside_island(*made_of)))
    parts = _shares(boundaries, spans, *borders, made_of, lane_width, line_distance)
    for k in np.flatnonzero(shared).tolist():
        parts[k] = _where_driven(parts[k], boundaries.s, estimate, np.maximum(parts[k].width - lane_width, 0.0), spans[k].count, some[k])
    for _, strip in groupby(zip(spans, parts), lambda one: (one[0].interval, one[0].left, one[0].right)):
        yield from _shared(list(strip), estimate.weights.most_in_doubt)


def _shares(boundaries, spans, rows, of, station, offset, made_of, lane_width, line_distance):
    """[LaneTrack] of spans, each with its share of the strip between its borders; the others as `_borders_of` gives them."""
    count, place, beside = (np.array([getattr(span, name) for span in spans]) for name in ("count", "place", "beside"))
    begin, width = lane_places(*offset, *made_of[:, of], count[of], lane_width, beside[of])
    painted, ragged, ends = boundaries.bounding[rows], SURFACE_END[made_of].any(axis=0), np.cumsum(np.bincount(of)).tolist()
    beside_one, places = painted[0] ^ painted[1], [slice(*pair) for pair in zip([0, *ends], ends)]
    for k in np.flatnonzero(beside_one & (ragged | bool(line_distance))).tolist():
        # the end of the surface is ragged, a lane is not
        even = 2 * line_distance or float(np.median(width[places[k]]))
        begin[places[k]] += (even - width[places[k]]) * count[k] * (not painted[0, k])
        width[places[k]] = even
    d = begin - width * (count - place - 0.5)[of]
    shown = (boundaries.seen[rows[:, of], station] & (painted | ~beside_one)[:, of]).sum(axis=0)
    status = np.where(shown == 2, np.where((count == 1) & painted.any(axis=0), MEASURED, INFERRED)[of], np.where(shown == 1, INFERRED, BRIDGED))
    # a curb that a lane reaches to shows its place too
    reaches = (made_of == BARE).any(axis=0)
    for k in np.flatnonzero(beside_one & ~ragged & ~reaches).tolist():
        between = np.subtract(*boundaries.d[rows[:, k, None], station[places[k]]])
        reaches[k] = np.nanmedian(np.abs(between - width[places[k]] * count[k])) < SAME_LANE
    left, right = np.where(place == count - 1, rows[0], -1), np.where(place == 0, rows[1], -1)
    values = [np.repeat(column, np.bincount(of)) for column in (beside_one & ~reaches, left, right, *(
        np.array([getattr(span, name) for span in spans]) for name in ("left_border", "right_border", "probability", "confidence")))]
    return [LaneTrack(int(station[part.start]), d[part], width[part], status[part], *(column[part] for column in values), span.direction,
                      np.full(part.stop - part.start, span.second, object)) for span, part in zip(spans, places)]


def _borders_of(boundaries, estimate):
    """The spans of which both borders are known, S of them: these, the rows of their borders, (2, S), and of all N places of one after the other
    the span, the station and the offsets of the borders, (2, N); and what the borders of each are made of, (2, S)."""
    c, spans = estimate.candidates, lane_spans(estimate)
    interval, rows = np.array([span.interval for span in spans], int), np.array([(span.left, span.right) for span in spans], int).reshape(-1, 2).T
    of, station = expand_ranges(c.first[interval], c.last[interval] + 1)
    offset = boundaries.d[rows[:, of], station]
    size, number = np.bincount(of, minlength=len(spans)), np.stack([np.bincount(of, side, len(spans)) for side in np.isfinite(offset)])
    for side, k in np.argwhere((number > 0) & (number < size)).tolist():
        places = slice(*np.searchsorted(of, [k, k + 1]))
        offset[side, places] = _filled(offset[side, places])
    if not (known := number.all(axis=0)).all():
        spans, rows, kept = [span for span, shown in zip(spans, known) if shown], rows[:, known], known[of]
        of, station, offset = (np.cumsum(known) - 1)[of[kept]], station[kept], offset[:, kept]
    pattern, kinds = boundaries.patterns[rows[:, of], station], BARE + 1
    number = np.bincount(((of + [[0], [len(spans)]]) * kinds + pattern).ravel(), minlength=2 * len(spans) * kinds)
    return spans, rows, of, station, offset, number.reshape(2, len(spans), kinds).argmax(axis=2)


def _shared(strip, most):
    """(interval, LaneTrack) of the lanes of a strip. Where one lies off its share, those that nobody drove have a confidence of `most` at most."""
    uneven = len(strip) > 1 and np.any([part.offset for _, part in strip], axis=0)
    for span, part in strip:
        yield span.interval, part if not np.any(uneven) else replace(
            part, confidence=np.where(uneven & ~part.offset, np.minimum(part.confidence, most), part.confidence))


def _where_driven(part, s, estimate, room, number, to_bare):
    """The LaneTrack of a lane moved from its share of the strip that it lies in to where it was driven.

    A lane is as wide as its share, or of the usual width and anywhere in the strip, which it shares with others evenly or as unlike as lanes of a
    road are; between two dashed lines they share it evenly but where a median without paint lies between them. Vehicles keep to the middle with some
    scatter; where one lane may have all of the strip, they rarely give way to something and show nothing. All these are normal errors about the
    middle, so it is moved as far as the drive is surer. A lane off the middle of which the drive lies is as doubtful as one with a second reading.

    room : (N,) m that its share is wider than usual; number : of lanes in the strip; to_bare : whether a border of the strip is not painted
    """
    weights, (beside, count) = estimate.weights, _driven_beside(part, s, estimate)
    anywhere, (whole, gutter, *_) = (number * room) ** 2 / 12, weights.left_over_beside
    if number > 1 and to_bare:
        even, variances = 1.0, np.stack([anywhere, anywhere + weights.width_sigma**2])   # m², of the place of the lane in both readings
    else:
        even, variances = whole[2] / gutter[2] if to_bare else np.exp(weights.bare[EDGE_LINE]), np.stack([0.0 * anywhere, anywhere])
    variance = variances + weights.track_sigma**2 / np.maximum(count, 1)
    probable = np.exp(-0.5 * beside**2 / variance) / np.sqrt(variance) * np.array([[even], [1.0]])
    nothing = (number == 1) * weights.odd_width * np.exp(-0.5 * (beside / weights.driven_sigma) ** 2) / weights.driven_sigma
    share, doubt = np.where(count > 0, np.stack([(probable * variances / variance).sum(axis=0), nothing]) / (probable.sum(axis=0) + nothing), 0.0)
    return replace(part, d=part.d + share * beside, width=part.width - share * room, offset=part.offset if number == 1 else share > 0.5,
                   confidence=part.confidence - doubt * np.maximum(part.confidence - weights.most_in_doubt, 0.0))


def _driven_beside(part, s, estimate):
    """(N,) m, where those drove who drove in a lane and along with it, from its middle, and how many they are."""
    beside = _drives(part.stations, s, estimate, part.direction)[0] - part.d
    inside = np.abs(beside) < part.width / 2
    count = inside.sum(axis=0)
    return np.where(inside, beside, 0.0).sum(axis=0) / np.maximum(count, 1), count


def _drives(stations, s, estimate, directions):
    """(P, N) m, offsets at (N,) stations of the grid of passes of some directions, between the middles of intervals, NaN where they did not drive;
    and (P,) which passes they are."""
    c, evidence = estimate.candidates, estimate.evidence
    there = np.isfinite(evidence.driven[:, np.searchsorted(c.first, stations, side="right") - 1])
    middle, passes = (s[c.first] + s[c.last]) / 2, np.flatnonzero(np.isin(evidence.directions, directions) & there.any(axis=1))
    offsets = [np.interp(s[stations], middle[seen], driven[seen]) for driven in evidence.driven[passes] for seen in [np.isfinite(driven)]]
    return np.where(there[passes], np.array(offsets).reshape(-1, len(stations)), np.nan), passes


def _filled(values):
    """Offsets with those that are missing at the ends of an interval."""
    finite = np.flatnonzero(np.isfinite(values))
    return np.interp(np.arange(len(values)), finite, values[finite])


def _followed(parts_of_lane, parts, first):
    """{part: lane} of the parts that go on as a lane, a list of parts, which ends right before them, one to one.

    Where another lane opens on one side, the border on the other side stays; one that divides evenly goes on as neither.
    """
    steps = np.full((len(parts), len(parts_of_lane)), np.inf)   # m, of both borders
    for k, part in enumerate(parts):
        for j, lane in enumerate(parts_of_lane):
            track = lane[-1]
            aside, wider = part.d[0] - track.d[-1], (part.width[0] - track.width[-1]) / 2
            of_borders = abs(aside + wider), abs(aside - wider)
            if track.last == first - 1 and track.direction == part.direction \
                    and min(of_borders) < TRACKS.max_lane_jump_share * min(part.width[0], track.width[-1]):
                steps[k, j] = sum(of_borders)
    # no other part and no other lane is as near
    return {k: j for k, j in np.argwhere(np.isfinite(steps)).tolist()
            if np.count_nonzero(steps[k] <= steps[k, j] + SAME_LANE) == np.count_nonzero(steps[:, j] <= steps[k, j] + SAME_LANE) == 1}


# Lanes that open or close beside another one along a taper.
#
# A lane that opens is driven from where it has its full width; up to there traffic stays in the lane beside it, which keeps its width although the
# line along its side has moved away already (as exit and turning lanes are laid out, e.g. RAA 6.4, RASt 6.3, AASHTO Green Book 9.7 and 10.9).


def laid_out(tracks: list[LaneTrack]) -> list[LaneTrack]:
    """The same lanes with through lanes as wide along tapers as beside the lanes that open there, and these from their full width on."""
    # each end of a lane with the lanes that lead on beside it, and where
    spans, openings = spans_of(tracks), []
    for k, head in ((k, head) for k in range(len(tracks)) for head in (True, False)):
        before = tracks[k].first - 1 if head else tracks[k].last + 1
        neighbours = [(j, _opening(tracks[k], tracks[j], head)) for j in spans.near(before, before).tolist() if j != k] if before >= 0 else []
        openings.append((k, head, [(j, station) for j, station in neighbours if station is not None]))
    through = [replace(track, d=track.d.copy(), width=track.width.copy(), status=track.status.copy()) for track in tracks]
    for k, head, opening_lanes in openings:
        for j, station in opening_lanes:
            _keep_width(through[j], tracks[k], station, head)
    for k, head, opening_lanes in openings:
        if opening_lanes:
            through[k] = _from_full_width(through[k], head)
    return through


def _opening(lane, other, head):
    """The station at which a lane that begins (or ends) first lies right beside another one that continues there; None where it does not.

    The other one may reach over its very beginning: lanes are distinguished by intervals, which are coarser than stations.
    """
    end, step = (lane.first, 1) if head else (lane.last, -1)
    if lane.direction != other.direction or not other.first <= end - step <= other.last:
        return None
    for station in range(end, end + step * min(STATIONS_OF_CELL + 1, len(lane)), step):
        (d, width), (d_other, width_other) = lane.at(station), other.at(station)
        if abs(abs(d - d_other) - (width + width_other) / 2) < TRACKS.missing_share * width_other:
            return station
    return None


def _keep_width(track, opens, at, head):
    """Make a through lane, in place, that before (or behind) the grid station at which another one lies beside it first no wider than beside that."""
    side = np.sign(opens.at(at)[0] - track.at(at)[0])
    at -= track.first
    margin, reach = int(TRACKS.end_width_length / STATION_STEP), int(TRACKS.longest_taper / STATION_STEP)
    widths = track.width[at:at + margin] if head else track.width[max(at - margin + 1, 0):at + 1]
    width = float(np.median(widths))
    ahead = np.arange(at - 1, max(at - reach, 0) - 1, -1) if head else np.arange(at + 1, min(at + reach, len(track) - 1) + 1)
    wider = track.width[ahead] > width + TRACKS.least_widening
    begin = int(np.argmax(wider))
    as_wide = np.flatnonzero(~wider[begin:])
    # a lane that is as wide all along divides into two, and has no taper
    if not wider[:int(TRACKS.border_before_lane / STATION_STEP)].any() or not len(as_wide):
        return
    ahead = ahead[begin:begin + int(as_wide[0])]
    track.d[ahead] -= side * (track.width[ahead] - width) / 2
    track.width[ahead] = width
    track.status[ahead] = np.maximum(track.status[ahead], INFERRED)


def _from_full_width(track, head):
    """A lane less what it is narrower than its full width at its beginning (or end)."""
    reach = int(TRACKS.longest_taper / STATION_STEP)
    width = track.width[:reach] if head else track.width[::-1][:reach]
    full = np.flatnonzero(width >= TRACKS.full_share * np.median(width))
    first = int(full[0])
    return track.part(first, len(track)) if head else track.part(0, len(track) - first)
