"""The one table of what is switched off: a row names a rule, where the core looks it up, what stands there instead, and the street it is for.

A rule is a function or a file that handles one situation, or one kind of evidence. Rules of reading a survey are not among them: they
are for files that lack something, and `make accuracy` judges those. What changes areas of lanes or uncertainties alone shows in no figure.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from lanewright.core.markings.cross_section.weights import EstimateWeights
from lanewright.core.markings.lines.selection import merged_pieces
from lanewright.core.markings.lines.strands import trace_strands
from lanewright.core.pipeline.road_map import RoadMapSettings
from lanewright.core.road.common.curb_points import CurbPoints
from lanewright.core.road.common.tracking import StepChain
from lanewright.core.road.curb_returns.steps import PlanSteps
from lanewright.core.road.profiles.steps import find_steps
from lanewright.core.road.weights import CURBS

DEFAULT = RoadMapSettings()
ALIKE = (1.0, 1.0, 1.0, 1.0)   # weights that tell no cross-section from another


@dataclass(frozen=True)
class Switch:
    """What is switched off, and how.

    name : for the page; group : of rules that are chosen together
    swaps : ((place, what stands there instead), ...), places as "room.file:function" or "room.file:Class.method" of the core
    street : for which the rule was made, as the commit that brought it says; "" where that is not known
    rule : files and functions that could go, as "room", "room.file" or "room.file:function"
    settings, stage : of the road map instead of a replaced function, and the first stage that feels them
    """

    name: str
    group: str
    swaps: tuple = ()
    street: str = ""
    rule: tuple = ()
    settings: RoadMapSettings = DEFAULT
    stage: str = ""


@dataclass(frozen=True)
class Around:
    """A stand-in that is made from what it replaces, or for what changes its arguments: whether it does anything its result does not tell."""

    make: Callable


def gives(value):
    return lambda *_, **__: value


def nth(k):
    """The argument of a number as it is."""
    return lambda *arguments, **_: arguments[k]


def none_of(k=0):
    """False for each row, or each cell, of an argument."""
    return lambda *arguments, **_: np.zeros(getattr(arguments[k], "shape", len(arguments[k])), bool)


def as_list(rows, *_):
    return list(rows)


def work_as_list(rows, *_):
    """The same where phases of other roads are run together with those of the rule: a work that asks for none."""
    yield from ()
    return list(rows)


def all_of(k):
    """True for each row of an argument."""
    return lambda *arguments: np.ones(len(arguments[k]), bool)


def filled(value):
    """The value for each row of the first argument."""
    return lambda rows, *_: np.full(len(rows), value)


def _room(group, room, *rows):
    """Switches of one room: (name, place, what stands there instead, street, files and functions of the rule).

    Rules are by default the function itself, with all that nothing else uses; "/" begins the name of another room.
    """
    found = []
    for name, place, instead, *more in rows:
        street, rule = (*more, "", "")[:2] if len(more) < 2 else more
        parts = [part[1:] if part[0] == "/" else f"{room}.{part.strip('.')}".strip(".")
                 for part in (rule or place).split()]
        found.append(Switch(name, group, ((f"{room}.{place}", instead),), street, tuple(parts)))
    return found


def _set(group, name, stage, rule="", **values):
    """A switch by settings: of the road map, or as {stage: its settings}."""
    values = {key: replace(getattr(DEFAULT, key), **value) if isinstance(value, dict) else value for key, value in values.items()}
    return Switch(name, group, rule=tuple(rule.split()), settings=replace(DEFAULT, **values), stage=stage)


def _evidence(name, make=None, **weights):
    """A kind of evidence for lines and lanes: its weights set to what tells nothing."""
    def weighing_less(original):
        return partial(original, weights=replace(EstimateWeights(), **weights))

    return Switch(f"evidence: {name}", "evidence", (("markings.cross_section.roads:estimate_roads", Around(make or weighing_less)),))


def nearest_steps(steps, _label, _width, limits):
    """The thesis's choice: on every profile the step nearest the vehicle, all in one chain."""
    slope = np.arctan2(steps.height, np.maximum(steps.run, 1e-6))
    good = np.flatnonzero((steps.height >= limits.clear_height) & (slope >= limits.clear_slope))
    order = good[np.lexsort((steps.u[good], steps.profile[good]))]
    first = order[np.r_[True, np.diff(steps.profile[order]) != 0]] if len(order) else order
    return [StepChain(first, float(steps.s[first].min()), float(steps.s[first].max()))] if len(first) else []


def _whole(chains, *_):
    return [(k, chain.start, chain.end) for k, chain in enumerate(chains)]


def _unaveraged(lines, section, settings, overgrown):
    return find_steps(lines.part(*section), CURBS.low_curb_share * settings.limits.least_height, settings.max_height)


def _no_main_islands(points, survey, _):
    return np.zeros(len(points), bool), {road: np.empty((2, 0)) for road in survey.store.roads()}


def _no_steps(*_, **__):
    return PlanSteps.none()


def _without_curbs(original):
    return lambda lines, frame, width, side="automatic", edges=None, *rest, **named: original(lines, frame, width, side, None, *rest, **named)


NO_ROWS, NO_NUMBERS = np.empty((0, 2), np.int64), np.empty(0, np.int64)
ROWS = (
    _set("curbs", "profiles method", "curbs", "road.profiles road.common.side_curbs:_curbs_of_side",
         boundary_method="scanlines"),
    _set("curbs", "scanlines method", "curbs", "road.scanlines road.common.side_curbs:_curbs_of_side",
         boundary_method="profiles"),
    Switch("chains along the road (else the nearest step)", "curbs", (
        ("road.common.tracking:curb_chains", nearest_steps), ("road.common.tracking:select_along_road", _whole),
        ("road.common.tracking:drop_short_curbs", nth(0))),
        rule=("road.common.tracking:curb_chains", "road.common.tracking:select_along_road", "road.common.tracking:drop_short_curbs")),
    *_room("curbs", "road",
        ("pieces in line", "common.tracking:pieces_between", gives([]), "residential street, parked cars, half the points",
         "common.tracking:with_pieces_in_line common.tracking:pieces_between"),
        ("weak chains that continue", "common.tracking:_continuing", gives([]), "residential street, parked cars, stations moved"),
        ("chains that go on unselected", "common.tracking:_continued", Around(gives(nth(0))), "residential street"),
        ("short curbs dropped", "common.tracking:drop_short_curbs", as_list, "flush cycle path with a false step of 3 m, crossing"),
        ("averages of noisy profiles", "profiles.detect:_steps_by_noise", _unaveraged, "many-beam scanner (Karlsruhe)",
         "profiles.steps:find_averaged_steps profiles.detect:_steps_by_noise"),
        ("profiles: ground stays up", "profiles.steps:_stays_up", all_of(3)),
        ("passes merged", "common.side_curbs:merged_passes", lambda found: type(found[0]).join(found)),
        ("scanlines: ground stays up", "scanlines.candidates:_stays_up", all_of(1)),
        ("scanlines: neighbours agree", "scanlines.candidates:_persistent", all_of(0)),
        ("scanlines: passes merged", "scanlines.detect:merged_corners", lambda found: type(found[0]).join(found)),
        ("hidden curb", "common.sides:hidden_points", gives([]), "parked cars",
         "common.sides:hidden_points common.sides:hidden_beside"),
        ("hidden curb beside later pieces", "common.sides:hidden_beside", lambda pieces, *_: CurbPoints.filled(0, pieces.crs),
         "parked cars, curb found in plan"),
        ("curb hidden in water", "common.occlusion:OcclusionGrid._in_water", none_of(1), "street with puddles along both curbs")),
    *_room("curb returns", "road.curb_returns",
        ("all curb returns", "detect:with_curb_returns", nth(0), "crossing, roundabout", "."),
        ("faint curbs", "extended_curbs:with_led_on", as_list, "curbs dropped to 1 or 2 cm, noisy scanner",
         "extended_curbs:with_led_on extended_curbs:led_on"),
        ("curbs beyond the corridor", "side_streets:with_curbs_beyond", work_as_list, "roundabout, crossing",
         "side_streets:with_curbs_beyond side_streets:GroundAboutArc"),
        ("steps followed", "extended_curbs:followed_steps", _no_steps, "crossing, ground of few points"),
        ("steps followed by few points", "extended_curbs:_few_all_around",
         lambda about, count, half: (np.empty(0, np.int64), tuple(column[:0] for column in about)), "crossing, ground of few points"),
        ("tops of islands", "islands:on_island_tops", none_of(), "island with a ramp"),
        ("far sides of islands", "islands:far_sides", _no_steps, "long islands"),
        ("islands among main curbs", "islands:on_main_islands", _no_main_islands, "tram stop"),
        ("short islands", "classify:_long_islands", as_list),
        ("main curbs found in plan alone", "classify:_own_curb", gives(None), "sparse curb far from others"),
        ("side streets with a hidden corner", "classify:_has_opposite_curb", gives(False), "noisy scanner, parked car in the corner"),
        ("straight part of a side street", "classify:_straight_part", lambda own: slice(0, len(own)), "crossing"),
        ("views ahead and behind of noisy scanners", "detect:_averaged_views", lambda raster, *_: [raster], "many-beam scanner (Karlsruhe)",
         "detect:_averaged_views ground_raster:averaged"),
        ("chains in plan joined", "tracking:join_chains", as_list),
        ("steps seen twice", "tracking:without_duplicates", lambda steps: np.arange(len(steps)))),
    *_room("edges", "road",
        ("outliers of curb points", "common.tracking:without_outliers", nth(0)),
        ("even bends across gaps", "common.lowered_curb:_line_across", gives((np.inf, None, "")), "bends with a junction; parked cars in a bend"),
        ("dropped corners", "edges.corner_edges:dropped_corners", gives([]), "corners dropped for a crossing")),
    *_room("surface", "road.surface",
        ("road edges bound the surface", "pavement_edge:edge_offsets",
         lambda edges, road, s: {side: (np.full(len(s), np.nan), np.zeros(len(s), bool)) for side in ("left", "right")}),
        ("edges of the pavement", "pavement_lines:with_pavement_edges", nth(1), "country roads, motorway"),
        ("darker patches", "pavement_limit:_darker_patch", lambda values, *_: np.zeros((len(values), 1)),
         "dark patch beside the edge of the pavement"),
        ("painted cells", "pavement_limit:_painted", none_of(), "edge line a hand from the verge, motorway"),
        ("mixed cells", "pavement_limit:_mixed", filled(0.0), "gravel along the asphalt"),
        ("between known cells", "pavement_limit:_between_known", lambda limit, weight: (limit, np.ones(len(limit))), "far side of a country road"),
        ("slope of the look", "pavement_limit:_without_slope", nth(0), "far side of a country road"),
        ("brighter strips along the road", "ground_change:other_ground_begins", filled(np.nan), "flush sidewalk or bicycle path"),
        ("road behind a blind zone", "ground_change:HalfProfiles._road_behind", gives(0), "scanner that does not look beside its vehicle"),
        ("ground that tilts away", "ground_change:_turns", none_of(1)),
        ("path that profiles agree with", "pavement_edge:_agreed", lambda changes, *_: changes.astype(float), "verges, gravel"),
        ("mouths of side streets", "extract:opened_limits", nth(0), "side streets not driven",
         "extract:opened_limits extract:street_ground extract:cells_driven"),
        ("narrow mouths of a wider road", "extract:_goes_on_wider", gives(False), "bays and widenings"),
        ("level flanks of mouths", "extract:_level_flanks", gives(0.0), "driveways"),
        ("streets driven themselves", "extract:cells_driven", lambda frame, road, cells: np.zeros(cells.height.shape, bool), "crossing, roundabout"),
        ("openings between pavement edges", "pavement_edge:_closed", nth(1), "one-way street with a flush bicycle path"),
        ("openings between curbs", "pavement_edge:_continued", nth(1)),
        ("rows without points", "road_surface:_as_far_as_measured", nth(0), "street with a crossing"),
        ("short changes of status", "road_surface:_without_short_runs", nth(0)),
        ("covered by obstacles", "road_points:covered_by_obstacles", none_of())),
    *_room("intensity", "intensity",
        ("beams made alike", "beams:Beams.of", gives(None), "many-beam scanner", "beams:Beams"),
        ("distances full of paint", "asphalt_model:_mixed", none_of()),
        ("sparse distances joined", "asphalt_model:_sparse_bins_joined", np.zeros_like, "thinned surveys"),
        ("logarithmic scale", "asphalt_model:is_logarithmic", gives(False)),
        ("averages of noisy scanners", "scatter:ScannerScatter.noisy_windows", gives(set()), "many-beam scanner (Karlsruhe)",
         "/markings.paint.noisy:noisy_paint_cells /markings.paint.noisy:CellAverages scatter:ScannerScatter"),
        ("ground around a spot of photographs", "scatter:_nats_of_photographs", gives(-np.inf), "brightness from photographs",
         "/markings.paint.photographs:bright_spots")),
    *_room("paint", "markings",
        ("gutters", "paint.not_paint:gutter_level", gives(np.float32(0.0)), "urban street with concrete gutters"),
        ("local level of asphalt", "paint.asphalt_level:background", gives(np.float32(0.0))),
        ("bright patches", "paint.asphalt_level:patch_level", gives(np.float32(0.0)), "pale repairs, parking places"),
        ("letters are no patch", "paint.asphalt_level:_letters", gives(False), "bus lane with bold letters"),
        ("dark cells", "paint.asphalt_level:dark_cells", none_of(), "asphalt beside water, tar, dark repairs (serpentine)"),
        ("pieces too small or too faint", "paint.not_paint:clear_pieces", nth(1)),
        ("rims of patches", "paint.windows:two_sided", gives(np.True_), "pale repairs across wheel tracks", "paint.not_paint:two_sided"),
        ("gaps between tracks", "paint.not_paint:_unseen_gaps", none_of(), "edge lines far from the vehicle"),
        ("specks between runs", "paint.not_paint:_between", none_of(), "worn lines"),
        ("raised things", "paint.not_paint:raised_cells", none_of(1), "ends of islands (roundabout), tram stop"),
        ("outliers", "outliers:remove_outliers", nth(0))),
    *_room("clusters", "markings",
        ("tracks of the scan linked", "objects.grouping:_across_tracks", gives(NO_ROWS), "sparse paint"),
        ("compounds divided", "objects.split_merge:are_compound", none_of(2), "stop line that meets an edge line",
         "objects.split_merge:are_compound objects.split_merge:parts_of_compound"),
        ("bars cut from lines", "objects.split_merge:bar_with_lines", lambda cells: np.zeros(len(cells), np.int64),
         "bends with a junction, worn stop line"),
        ("fragments joined", "objects.split_merge:join_fragments", lambda shapes, _: np.arange(len(shapes)), "worn lines"),
        ("gaps between oblique tracks joined", "objects.split_merge:_unseen_gaps", gives(NO_ROWS), "edge lines far from the vehicle"),
        ("pieces of bars joined", "objects.split_merge:_bars", gives(NO_ROWS), "worn stop lines"),
        ("rows of blocks divided", "objects.cluster:_with_rows_divided", nth(1), "roundabout, give-way blocks"),
        ("zebra crossings", "objects.repeating:stripes_of_crossing", gives([]), "",
         "objects.repeating:stripes_of_crossing objects.repeating:comb_of_window")),
    *_room("classes", "markings.objects",
        ("give-way blocks", "repeating:give_way_blocks", none_of(), "roundabout"),
        ("zigzag lines", "shape:zigzag_legs", gives(0), "zigzag lines before crossings"),
        ("figures (bicycle and BUS)", "figures:painted_figures", gives([]), "cycle lanes, bus lane",
         "figures:painted_figures figures:figure_of_cells figures:agreement"),
        ("contrast", "classify:too_pale", gives(False), "pale edge line beside bright paint"),
        ("beyond the edge line", "classify:_beyond_the_edge_line", none_of(1), "verge outside an edge line"),
        ("rows of short dashes", "classify:_dashes_in_rows", none_of(), "cycle lanes with dashes of 1 m"),
        ("partners of double lines", "classify:_has_partner", none_of(1)),
        ("outlines of hatching", "classify:_outlines", gives(NO_NUMBERS), "many-beam scanner (Karlsruhe)"),
        ("single bars", "classify:_single_bars", gives(NO_NUMBERS)),
        ("specks", "classify:_speck", gives(False)),
        ("round covers", "classify:_round_cover", gives(False)),
        ("hairs at the curb", "classify:_curb", gives(False), "curb tops beside an edge line"),
        ("strips of gutter", "classify:_gutter", gives(False))),
    *_room("outlines", "markings.objects",
        ("small holes", "shape:_without_small_holes", nth(0)),
        ("beyond the last point", "shape:_beyond_the_last", gives(0), "sample survey")),
    *_room("lines", "markings.lines",
        ("lines of few tracks", "strands:painted_strands", trace_strands, "lines far from the vehicle"),
        ("lines in mixed markings", "strands:_narrow_there", none_of()),
        ("common trend", "linking:CommonTrend.at", lambda self, s: np.zeros(np.shape(s)), "", "linking:CommonTrend"),
        ("edges beside lines", "strands:EdgesBeside.between", gives(None), "edge lines worn where a road widens",
         "strands:EdgesBeside strands:edges_beside"),
        ("long gaps", "linking:link_over_long_gaps", nth(0)),
        ("long gaps beside another line", "linking:_runs_beside", gives(False)),
        ("long gaps of a dash pattern", "selection:same_dash_pattern", gives(False)),
        ("between twins", "linking:_between_twins", gives(False), "", "linking:_between_twins linking:twin_offsets"),
        ("ragged edges and double lines", "selection:_beside",
         lambda lines, *_: (np.zeros(len(lines), bool), [(np.empty(0), np.empty(0, bool))] * len(lines))),
        ("dashed lines end with a gap", "selection:_extended", lambda drawn, *_: merged_pieces(drawn)),
        ("guides in long gaps", "fit:_guides", gives((np.empty(0), np.empty(0))), "bends, gap of 27 m"),
        ("paint between tracks", "linking:with_unseen_paint", lambda lines, *_: replace(lines, unseen=[np.empty((0, 3))] * len(lines)),
         "tram street, far solid lines", "linking:with_unseen_paint linking:with_paint_between_tracks")),
    *_room("cross-section", "markings",
        ("dashed lines go on by a gap", "cross_section.sections:lengthen_dashed", Around(gives(gives(None)))),
        ("surface ends at seen edges", "cross_section.candidates:_at_edges", lambda surface, *_: (surface, np.zeros(surface.shape, bool)),
         "country road with a centre line alone"),
        ("wide lines", "cross_section.candidates:_wide_share", lambda lines: np.full(lines.d.spans.size, np.nan), "streets with a bus lane"),
        ("slivers and doubled ends", "cross_section.candidates:_superfluous", lambda entries, _: np.zeros(len(entries["d"]), bool)),
        ("streets without paint", "cross_section.roads:_driven_bare", gives((np.empty(0), np.empty(0))),
         "residential street, one-way street without paint"),
        ("where one drives beside a curb", "cross_section.beside:_driven_beside", lambda offset, *_: (np.zeros(offset.shape[1]),) * 2,
         "main streets whose lanes reach up to the curb, and those with gutters"),
        ("lanes beside islands", "cross_section.sequence:beside_island", gives(np.zeros((), bool)), "island beside an edge line"),
        ("the road's own lane width", "cross_section.roads:_usual_width", lambda _known, _estimates, usual: (usual, False))),
    *_room("lanes", "driving",
        ("tapers", "lanes:laid_out", nth(0), "slip road that joins"),
        ("lanes to the ends of their borders", "lanes:_to_its_ends", nth(0)),
        ("steps between stretches evened out", "lanes:_without_steps", lambda parts: type(parts[0]).joined(parts), "island beside an edge line"),
        ("lanes connected", "lane_track:connect", nth(0)),
        ("doubtful ends", "lane_track:LaneTrack.without_doubtful_ends", nth(0), "turns from road to road"),
        ("common alignment", "alignment:_of_lane", gives([]), "")),
    _set("intensity", "correction of intensity", "intensity",
         "intensity.correction:correct_intensity intensity.asphalt_model:AsphaltTable intensity.asphalt_model:IntensityHistograms",
         correct=False),
    _set("paint", "outliers by window (else the whole survey)", "outliers", outliers=dict(scope="all")),
    _set("intensity", "bright points count more", "image", image=dict(beta=0.0)),
    _evidence("where and which way the vehicle drove", driven_rest=0.0, driven_against=0.0, driven_astride=0.0),
    _evidence("curbs", _without_curbs),
    _evidence("asphalt where no lane is and lanes beside the asphalt", unused_asphalt=(0.0, 0.0), unused_wide=0.0, off_asphalt=0.0,
              lane_through_surface=0.0),
    _evidence("no lane over a painted line", lane_through_paint=0.0, paint_in_rest=0.0),
    _evidence("how lines are drawn", solid=ALIKE, dashed=ALIKE, double=ALIKE, wide_solid=ALIKE, wide_dashed=ALIKE),
    _evidence("no border between lanes without paint", unpainted_divider=0.0, unpainted_lane_line=0.0),
    _evidence("widths of lanes", other_width=0.0, odd_width=1.0),
    _evidence("hatched areas", hatched_lane=0.0, lane_through_hatching=0.0),
    _evidence("where arrows lie", arrow_outside=0.0),
    _evidence("which way arrows point", arrow_against=0.0),
    _evidence("stop lines", split_stop=0.0, outer_stopped=0.0),
    _evidence("which way arrows point and stop lines", arrow_against=0.0, split_stop=0.0, outer_stopped=0.0),
    _evidence("how many lanes lead which way", one_way=(0.0,) * 4, uneven=0.0, two_and_one=0.0),
    _evidence("another carriageway driven beside this one", two_way_carriageway=0.0),
    _evidence("a road driven more than once and never back", never_back=0.0),
    _evidence("traffic keeps to its side", wrong_side=0.0, left_hand=0.0, foreign_side=0.0),
    _evidence("lanes go on along the road", change=0.0, turn=0.0, divider_change=0.0),
)
SWITCHES = {switch.name: switch for switch in ROWS}
