"""Intensity without the effect of range and incidence, scanner by scanner, from the road's own asphalt; what is saturated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..common.parallel import ordered_map
from ..common.progress import Progress
from ..common.setting import Limited, choice
from ..execution.in_step import Asked, Work, in_step
from ..survey.frame.road_frame import Pass, RoadFrame
from ..survey.store.records import Points
from ..survey.store.road_points import RoadPoints
from ..survey.store.section_store import StoreIndex, Stretch
from .asphalt_model import (
    ACROSS_TRACK,
    INTENSITY_LEVELS,
    LOWER_QUANTILE,
    UNKNOWN_DISTANCE,
    AsphaltTable,
    BinCounts,
    IntensityHistograms,
    VehicleDistances,
    asphalt_of_histograms,
    to_intensity,
    to_level,
)
from .beams import Beams, phase_of_stretches
from .scatter import ScannerScatter, scanner_scatter
from .weights import ASPHALT

# Saturated intensities: values that a scanner or an export cut off at an end of their range.

MAX_SHARE_AT_LOWEST = LOWER_QUANTILE   # derived: share at its lowest: the quantile from which asphalt's spread is taken
SCANNER_NUMBERS = 256   # derived: numbers that a scanner may have
PHOTOGRAPHED = ("Intensity was not corrected: it is that of photographs, whose brightness does not depend on the distance from the scanner.")
REMEDY = "Export the cloud with the scanner's full intensities (16 bits, not stretched)."


@dataclass(frozen=True)
class _Saturation:
    """The ends of the range of a road's intensities.

    at_lowest, at_highest : shares of points within 1.1 % of their scanner's lowest and highest, 0 where they do not accumulate there
    """

    lowest: float = float("nan")   # lowest, highest: intensities, raw counts
    at_lowest: float = 0.0
    highest: float = float("nan")
    at_highest: float = 0.0

    @classmethod
    def from_levels(cls, levels: np.ndarray, highest: float | None = None) -> _Saturation:
        """_Saturation of (scanners, INTENSITY_LEVELS) counts of points; `highest` is the highest intensity, where it is known exactly."""
        levels = levels[levels.any(axis=1)]
        if not len(levels):
            return cls()
        total, used = levels.sum(), np.flatnonzero(levels.any(axis=0))
        at_lowest, at_highest = (float(sum(map(_accumulated, side)) / total) for side in (levels, levels[:, ::-1]))
        low, high = np.rint(to_intensity(used[[0, -1]])).tolist()
        return cls(low, at_lowest, high if highest is None else float(highest), at_highest)

    @property
    def warning(self) -> str:
        """What the user should know of it, "" where nothing was cut off."""
        texts = []
        if self.at_highest >= ASPHALT.max_share_at_highest:
            texts.append(f"{100 * self.at_highest:.0f} % of the road's points have the highest intensity, {self.highest:.0f}: brighter values "
                         "were cut off, and paint there may be missed.")
        if self.at_lowest >= MAX_SHARE_AT_LOWEST:
            texts.append(f"{100 * self.at_lowest:.0f} % of the road's points have the lowest intensity, {self.lowest:.0f}: darker values "
                         "were cut off, and bright spots of asphalt may be taken for paint.")
        return " ".join([*texts, REMEDY]) if texts else ""


def _accumulated(counts):
    """Points in the first level that has any, if they are more than those of the next two; else 0."""
    used = np.flatnonzero(counts)[:3]
    first, *following = counts[used].tolist()
    return first if first > sum(following) and following else 0


def saturation_of(road_points: RoadPoints) -> _Saturation:
    """_Saturation of the raw intensities of road points."""
    def count(key):
        points, levels = road_points.section(*key), np.zeros(SCANNER_NUMBERS * INTENSITY_LEVELS, np.int64)
        intensity, scanner = points.intensity, points.scanner
        for first in range(0, len(points), ASPHALT.points_at_once):
            rows = slice(first, first + ASPHALT.points_at_once)
            levels += np.bincount(scanner[rows].astype(np.int32) * np.int32(INTENSITY_LEVELS) + to_level(intensity[rows]), minlength=len(levels))
        return levels

    counts = sum(ordered_map(count, road_points.all_sections()), np.zeros(SCANNER_NUMBERS * INTENSITY_LEVELS, np.int64))
    return _Saturation.from_levels(counts.reshape(SCANNER_NUMBERS, INTENSITY_LEVELS))


@dataclass(frozen=True)
class IntensitySettings(Limited):
    # "automatic" decides between linear and logarithmic by the spread of asphalt; "linear" multiplies, "logarithmic" adds
    scale: str = choice("automatic", ("automatic", "linear", "logarithmic"), "The intensity scale")


@dataclass
class _IntensityReport:
    """Result of a correction in numbers.

    scanners : a dict per scanner: scanner, points, nearest and farthest (m from the track), asphalt_before, asphalt_after (medians over the
        distances), fall_before, fall_after (highest over lowest asphalt), spread_before, spread_after (coefficient of variation of asphalt over the
        distances, %)
    """

    scale: str = ""   # "linear", "logarithmic", or "" where nothing was corrected
    reference: float = float("nan")   # the intensity that asphalt was brought to
    scanners: list[dict[str, Any]] = field(default_factory=list)
    spread_before: float = float("nan")   # spread_before, spread_after: coefficient of variation of asphalt over distances and scanners, %
    spread_after: float = float("nan")
    beams: int = 0   # how many beams of spinning scanners were equalised, 0 where there are none
    saturation: _Saturation = _Saturation()   # whether intensities were cut off at an end
    reason: str = ""   # why nothing was corrected, "" where it was

    def lines(self) -> list[str]:
        """Sentences for a log."""
        if self.reason:
            return [self.reason]
        texts = [f"The intensity scale is {self.scale}; asphalt was brought to {self.reference:.0f}. Its level varies by "
                 f"{self.spread_after:.1f} % over distances and scanners, {self.spread_before:.1f} % before."]
        if self.beams:
            texts[0] += f" {self.beams} beams of unequal brightness were equalised."
        texts += [self.saturation.warning] if self.saturation.warning else []
        for row in self.scanners:
            texts.append(f"Scanner {row['scanner']}: asphalt varies by {row['spread_after']:.1f} % from {row['nearest']:.0f} to "
                         f"{row['farthest']:.0f} m, {row['spread_before']:.1f} % before.")
        return texts


@dataclass(frozen=True)
class AsphaltLook:
    """What road points show of asphalt, by which these and others of the same survey are corrected."""

    table: AsphaltTable | None   # AsphaltTable, None where nothing can be corrected
    reason: str   # why not, "" where it can
    beams: Beams | None = None   # Beams whose brightness is made equal
    step: int = 1   # points in every step-th centimetre of the road are counted
    points_by_scanner: np.ndarray = field(default_factory=lambda: np.zeros(SCANNER_NUMBERS, np.int64))   # (256,) points of each scanner
    counts: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))   # of the IntensityHistograms of raw intensities
    highest: int = 0   # intensity
    scatter: ScannerScatter | None = None   # how single points scatter, None where nothing was looked at

    @classmethod
    def of(cls, road_points: RoadPoints, frame: RoadFrame, settings: IntensitySettings = IntensitySettings(),
           progress: Progress = Progress()) -> AsphaltLook:
        """What `correct_intensity` does in its first round."""
        reason = _reason_against(road_points, frame)
        if reason:
            return cls(None, reason)
        points_by_scanner = road_points.points_of_scanners()
        scanners = int(np.flatnonzero(points_by_scanner)[-1]) + 1
        beams = Beams.of(road_points, frame, scanners, progress.part(0.0, 0.4))
        step, scatter = _sampling_step(road_points), scanner_scatter(road_points)
        counted = _levels(road_points, frame, beams, scanners, step)
        (before, table, highest, reason), scattered = in_step([counted, scatter], road_points.executor, progress.part(0.4, 1.0))
        if table is not None and settings.scale != "automatic":
            table.logarithmic = settings.scale == "logarithmic"
        if scattered.photographed > 0.0:
            reason = PHOTOGRAPHED
        return cls(table, reason, beams, step, points_by_scanner, before.counts, highest, scattered)


def _levels(road_points, frame, beams, scanners, step):
    """The work that counts intensities: IntensityHistograms, AsphaltTable or None, the highest intensity, and why nothing can be corrected."""
    before = IntensityHistograms(scanners)
    modelled = IntensityHistograms(scanners) if beams else before

    def take(result):
        raw, equal, *others = result
        before.add(raw, step)
        modelled.add(equal, step)
        return [others]

    phase = phase_of_stretches(levels_of_stretch, road_points, (list(frame.passes), beams, scanners, step))
    highest, lost = zip(*(yield Asked(phase, road_points.stretches(), 1.0, read=take)))
    table = AsphaltTable.from_counts(modelled.counts)
    return before, table, max(highest), _reason_of_counts(table, *np.sum(lost, axis=0).tolist())


def correct_intensity(road_points: RoadPoints, frame: RoadFrame, settings: IntensitySettings = IntensitySettings(),
                      progress: Progress = Progress()) -> tuple[RoadPoints, _IntensityReport]:
    """Bring asphalt to one intensity at every distance and for every scanner.

    The beams of a spinning scanner are equalised first, where they differ. In a first round the intensities are counted by scanner and distance from
    the vehicle, left and right apart (of dense roads in stripes across the road); the asphalt I0 of each bin is the median of what is not paint.
    In the second round every intensity I becomes::

        I * reference / I0      on a linear scale
        I + reference - I0      on a logarithmic scale, where asphalt keeps its spread while its level falls

    The correction is our own: it needs neither the range nor the angle of incidence of a point.

    frame : RoadFrame of the same trajectory

    Returns RoadPoints with `corrected`; the raw intensity stays, and all other columns are shared with
        `road_points`. NaN for a point measured when the vehicle's position is not known, or by a scanner with too few points to
        know its asphalt. Where nothing can be corrected, the points are returned as they were.
    _IntensityReport; its `reason` says why nothing was corrected
    """
    asphalt = AsphaltLook.of(road_points, frame, settings, progress.part(0.0, 0.5))
    return in_step([intensity_corrected(road_points, frame, asphalt, progress)], road_points.executor, progress.part(0.5, 1.0))[0]


def intensity_corrected(road_points: RoadPoints, frame: RoadFrame, asphalt: AsphaltLook, progress: Progress) -> Work:
    """The work of the second round of `correct_intensity`; `progress` is told what was done."""
    if asphalt.reason or asphalt.table is None:
        progress.warn(asphalt.reason)
        return road_points, _IntensityReport(reason=asphalt.reason)
    table, after = asphalt.table, IntensityHistograms(asphalt.counts.shape[1])
    kinds = np.unique(table.distance_kind[asphalt.points_by_scanner[:len(table.distance_kind)] > 0]).tolist()
    store = road_points.store.with_column("corrected", road_points.store.folder)
    arguments = list(frame.passes), asphalt.beams, table, table.lookup(), kinds, asphalt.step

    def take(result):
        index, counts = result
        store.adopt(index, store.folder)
        after.add(counts, asphalt.step)
        return []

    phase = phase_of_stretches(corrected_of_stretch, road_points, arguments, replace(road_points, store=store))
    yield Asked(phase, road_points.stretches(), 1.0, read=take)
    report = _report(asphalt.counts, after.counts, table, asphalt.points_by_scanner)
    report.beams = sum(map(len, asphalt.beams.corrections.values())) if asphalt.beams else 0
    report.saturation = _Saturation.from_levels(asphalt.counts[ACROSS_TRACK].sum(axis=1), asphalt.highest)
    if report.saturation.warning:
        progress.warn(report.saturation.warning)
    for line in report.lines()[:1]:
        progress.info(line)
    return replace(road_points, store=store, has_corrected=True), report


def _reason_of_counts(table, lost, points):
    """Why nothing can be corrected with a table of asphalt, of which so many points had no position of the vehicle; "" where it can."""
    if lost > ASPHALT.max_share_without_vehicle * points:
        return (f"Intensity was not corrected: the trajectory does not say where the vehicle was when {lost:,} of {points:,} points were measured.")
    if table is None:
        return "Intensity was not corrected: there are too few road points to estimate the intensity of asphalt at each distance."
    return ""


def levels_of_stretch(road_points: RoadPoints, stretch: Stretch, passes: Sequence[Pass], beams: Beams | None, scanners: int,
                      step: int) -> tuple[list[BinCounts], list[BinCounts], int, np.ndarray]:
    """The phase that counts intensities.

    beams : Beams whose brightness is made equal, None for none
    scanners : their numbers are below this
    step : points in every step-th centimetre of the road are counted

    Returns
        raw, equal : counts of intensities, as they are and with equal beams (none without)
        highest : intensity
        lost : (2,) points without a position of the vehicle, and all points
    """
    histograms = IntensityHistograms(scanners)
    raw, equal, highest, lost = [], [], 0, np.zeros(2, np.int64)
    for key in road_points.store.in_stretch(stretch):
        points = _stripes(road_points.section(*key), step)
        distances = VehicleDistances(passes, points.time).of(points)
        raw.append(histograms.count(points.scanner, distances, points.intensity))
        if beams:
            equal.append(histograms.count(points.scanner, distances, beams.equalised(points)))
        highest = max(highest, int(points.intensity.max(initial=0)))
        lost += np.count_nonzero(distances[0] == UNKNOWN_DISTANCE), len(points)
    return IntensityHistograms.together(raw), IntensityHistograms.together(equal), highest, lost


def corrected_of_stretch(road_points: RoadPoints, stretch: Stretch, passes: Sequence[Pass], beams: Beams | None, table: AsphaltTable,
                         lookup: np.ndarray, kinds: list[int], step: int) -> tuple[StoreIndex, list[BinCounts]]:
    """The phase that corrects intensities, those of the points that the store of `road_points` puts a column beside.

    passes, beams, step : as of `levels_of_stretch`
    table, lookup : AsphaltTable and its `lookup`
    kinds : kinds of distance that it needs

    Returns where the corrected intensities lie in parts of a store, and counts of them.
    """
    histograms, counts = IntensityHistograms(len(table.distance_kind)), []
    store: Any = road_points.store
    with store.part() as part:
        for key in store.base.in_stretch(stretch):
            records = store.base.section(*key)
            points = Points(records)
            corrected, distances_of = np.empty(len(points), np.float32), VehicleDistances(passes, points.time).of
            for first in range(0, len(points), ASPHALT.points_at_once):
                batch = points[first:first + ASPHALT.points_at_once]
                distances = distances_of(batch, kinds)
                distance: Any = distances[0] if len(distances) == 1 else np.where(table.distance_kind[batch.scanner] == ACROSS_TRACK, *distances)
                correction, intensity = table.corrections(lookup, batch.scanner, distance), beams.equalised(batch) if beams else batch.intensity
                np.add(intensity, correction, out=correction) if table.logarithmic else np.multiply(intensity, correction, out=correction)
                corrected[first:first + ASPHALT.points_at_once] = correction
            records = records.with_columns(corrected=corrected)
            sample = _stripes(Points(records), step)
            counts.append(histograms.count(sample.scanner, distances_of(sample, kinds), sample.corrected, kinds))
            part.put(*key, records)
    return part.index(), IntensityHistograms.together(counts)


def _sampling_step(road_points):
    """n, where one of n centimetres of road is sampled for the level of asphalt; its points stand for those of all n."""
    length = sum(end - start for start, end in map(road_points.store.span, road_points.roads()))
    return max(int(len(road_points) / max(length, 1.0) / ASPHALT.enough_points_per_metre), 1)


def _stripes(points, step):
    """The points in every step-th centimetre of the road, the same ones however sections are cut."""
    s = points.records["s"]
    if step == 1 or not len(s):
        return points
    period = ASPHALT.sample_stripe_length * step
    first = np.arange(s[0] // period, s[-1] // period + 1) * period
    begins, ends = np.searchsorted(s, first), np.searchsorted(s, first + ASPHALT.sample_stripe_length)
    count = ends - begins
    return points[np.repeat(begins - (np.cumsum(count) - count), count) + np.arange(count.sum())]


def _reason_against(road_points, frame):
    """Why nothing can be corrected, "" where it can."""
    if not len(road_points):
        return "There are no road points whose intensity could be corrected."
    if not frame.has_time:
        return ("Intensity was not corrected: without gps_time in the cloud and time in the trajectory the distance "
                "from scanner to point is not known.")
    return ""


def _report(before, after, table, points_by_scanner):
    rows = table.distance_kind, np.arange(len(table.distance_kind))
    medians = [asphalt_of_histograms(counts[rows])[0] for counts in (before, after)]
    weight = before[rows].sum(axis=-1)
    usable = table.known & np.isfinite(medians[0]) & np.isfinite(medians[1])
    report = _IntensityReport("logarithmic" if table.logarithmic else "linear", table.reference)
    distances = np.abs(np.arange(weight.shape[1]) * ASPHALT.distance_bin + ASPHALT.distance_bin / 2 - ASPHALT.max_distance)
    for scanner in np.flatnonzero(usable.any(axis=1)):
        use = usable[scanner]
        row = dict(scanner=int(scanner), points=int(points_by_scanner[scanner]),
                   nearest=float(distances[use].min()), farthest=float(distances[use].max()))
        for name, levels in zip(("before", "after"), medians):
            mean, variation = _variation(levels[scanner, use], weight[scanner, use])
            row.update({f"asphalt_{name}": mean, f"spread_{name}": variation,
                        f"fall_{name}": float(levels[scanner, use].max() / max(levels[scanner, use].min(), 1e-9))})
        report.scanners.append(row)
    report.spread_before, report.spread_after = (_variation(levels[usable], weight[usable])[1] for levels in medians)
    return report


def _variation(values, weights):
    """Weighted mean and coefficient of variation (%)."""
    mean = float((values * weights).sum() / weights.sum())
    return mean, float(100.0 * np.sqrt((weights * (values - mean) ** 2).sum() / weights.sum()) / max(abs(mean), 1e-9))
