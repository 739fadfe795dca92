"""Intensity freed of range and incidence, scanner by scanner, from the road's own asphalt."""

from dataclasses import dataclass, field, replace

import numpy as np

from ..common.errors import RoadExtractionError
from ..common.parallel import ordered_map
from ..common.progress import Progress
from ..survey.store.records import Points
from .asphalt_model import BIN, REACH, AsphaltTable, LevelCounts, asphalt_of
from .beams import Beams
from .saturation import Clipping
from .vehicle_relative import ACROSS, UNKNOWN, Tracks

ENOUGH = 6_000   # points of a metre of road: more tell nothing new of asphalt
STRIPE = 100    # units of 0.1 mm along the road: where there are more, stripes of it are looked at
AT_ONCE = 1 << 15  # points corrected at a time: what fits the processor's cache
WITHOUT_VEHICLE = 0.2   # share of points that may lack a vehicle's position before the correction is given up


@dataclass(frozen=True)
class IntensitySettings:
    """How intensity is corrected.

    scale : "automatic" tells linear from logarithmic intensities by the spread
        of asphalt; "linear" multiplies, "logarithmic" adds
    """

    scale: str = "automatic"

    def __post_init__(self):
        if self.scale not in ("automatic", "linear", "logarithmic"):
            raise RoadExtractionError(f"The intensity scale is {self.scale!r}; it is one of automatic, linear, logarithmic.")


@dataclass
class IntensityReport:
    """What the correction found and did.

    scale : "linear", "logarithmic", or "" where nothing was corrected
    reference : the intensity that asphalt was brought to
    scanners : a dict per scanner: scanner, points, nearest and farthest (m from the track), asphalt_before,
        asphalt_after (medians over the distances), fall_before, fall_after (highest
        over lowest asphalt), spread_before, spread_after (coefficient of variation of
        asphalt over the distances, %)
    beams : how many beams of spinning scanners were evened, 0 where there are none
    between_before, between_after : highest over lowest scanner's asphalt
    clipping : whether intensities were cut off at an end
    reason : why nothing was corrected, "" where it was
    """

    scale: str = ""
    reference: float = float("nan")
    scanners: list = field(default_factory=list)
    between_before: float = float("nan")
    between_after: float = float("nan")
    spread_before: float = float("nan")
    spread_after: float = float("nan")
    beams: int = 0
    clipping: Clipping = Clipping()
    reason: str = ""

    @property
    def clipped(self):
        """What to say of intensities that were cut off, "" where they were not."""
        return self.clipping.warning

    def lines(self):
        """Sentences for a log."""
        if self.reason:
            return [self.reason]
        texts = [f"Intensity looks {self.scale}; asphalt was brought to {self.reference:.0f}. Its level varies by "
                 f"{self.spread_after:.1f} % over distances and scanners, {self.spread_before:.1f} % before."]
        if self.beams:
            texts[0] += f" {self.beams} beams of unequal brightness were made alike."
        texts += [self.clipped] if self.clipped else []
        for row in self.scanners:
            texts.append(f"Scanner {row['scanner']}: asphalt varies by {row['spread_after']:.1f} % from {row['nearest']:.0f} to "
                         f"{row['farthest']:.0f} m, {row['spread_before']:.1f} % before.")
        return texts

    def to_html(self):
        """The report as a page of its own."""
        from ..report.page import Page

        page = Page("Intensity correction", "Asphalt's intensity by scanner, before and after. Distances are from the track of the vehicle.")
        for line in [*self.lines()[:1], self.clipped]:
            if line:
                page.text(line)
        if self.scanners:
            page.table(("Scanner", "Points", "From (m)", "To (m)", "Asphalt before", "Asphalt after", "Variation before (%)",
                        "Variation after (%)", "Highest/lowest before", "Highest/lowest after"),
                       [[row[name] for name in ("scanner", "points", "nearest", "farthest", "asphalt_before", "asphalt_after",
                                                "spread_before", "spread_after", "fall_before", "fall_after")] for row in self.scanners])
        return page.html()


def correct_intensity(road_points, frame, settings=IntensitySettings(), progress=Progress()):
    """Bring asphalt to one intensity at every distance and for every scanner.

    The beams of a spinning scanner are made alike first, where they are not.
    In a first round the levels of points are counted by scanner and distance from the
    vehicle, left and right apart (where points crowd, of those in stripes across the
    road); the asphalt I0 of each bin is the median of what is not paint. In the second every point becomes I * reference / I0, or
    I + reference - I0 where the intensities are logarithmic: there asphalt
    keeps its spread while its level falls.

    Parameters
    ----------
    road_points : RoadPoints
    frame : RoadFrame of the same trajectory

    Returns
    -------
    RoadPoints with `corrected` (the raw intensity stays, and all other columns are
    shared with `road_points`; NaN for a point measured when the vehicle's place is not known,
    or by a scanner with too few points to know its asphalt), IntensityReport. Where the vehicle's place at a
    point's time is not known the points come back as they were, and the report
    says why.
    """
    reason = _why_not(road_points, frame)
    if reason:
        progress.warn(reason)
        return road_points, IntensityReport(reason=reason)
    sections = road_points.all_sections()
    by_scanner = sum(ordered_map(lambda key: _by_scanner(road_points.section(*key)), sections))
    scanners = int(np.flatnonzero(by_scanner)[-1]) + 1
    beams = Beams.of(road_points, frame, scanners, progress.part(0.0, 0.2))
    even = beams.even if beams else (lambda points: points.intensity)
    step = _step(road_points)
    before, after = LevelCounts(scanners), LevelCounts(scanners)
    evened = LevelCounts(scanners) if beams else before

    def count(key):
        points = _stripes(road_points.section(*key), step)
        places = Tracks(frame.passes, points.time).places(points)
        raw = before.of(points.scanner, places, points.intensity)
        even_ones = evened.of(points.scanner, places, even(points)) if beams else ()
        return raw, even_ones, points.intensity.max(initial=0), np.count_nonzero(places[0] == UNKNOWN), len(points)

    placeless, highest = np.zeros(2, np.int64), 0
    for raw, even_ones, brightest, *lost in ordered_map(count, sections, progress.part(0.2, 0.5)):
        before.add(raw, step)
        evened.add(even_ones, step)
        placeless += lost
        highest = max(highest, brightest)
    table = AsphaltTable.of(evened.counts)
    if placeless[0] > WITHOUT_VEHICLE * placeless[1]:
        reason = ("Intensity was left as it is: the trajectory does not say where the vehicle was when "
                  f"{placeless[0]:,} of {placeless[1]:,} points were measured.")
    elif table is None:
        reason = "Intensity was left as it is: there are too few road points to learn from how asphalt looks at each distance."
    if reason:
        progress.warn(reason)
        return road_points, IntensityReport(reason=reason)
    if settings.scale != "automatic":
        table.logarithmic = settings.scale == "logarithmic"

    ways, lookup = np.unique(table.told_by[by_scanner[:scanners] > 0]).tolist(), table.lookup()

    def correct(key):
        points = road_points.section(*key)
        corrected, tracks = np.empty(len(points), np.float32), Tracks(frame.passes, points.time)
        for first in range(0, len(points), AT_ONCE):
            here = points[first:first + AT_ONCE]
            places = tracks.places(here, ways)
            place = places[0] if len(places) == 1 else np.where(table.told_by[here.scanner] == ACROSS, *places)
            found = table.looked_up(lookup, here.scanner, place)
            np.add(even(here), found, out=found) if table.logarithmic else np.multiply(even(here), found, out=found)
            corrected[first:first + AT_ONCE] = found
        some = _stripes(Points(points.records.with_columns(corrected=corrected)), step)
        return key, corrected, after.of(some.scanner, tracks.places(some, ways), some.corrected, ways)

    result = replace(road_points, store=road_points.store.with_column("corrected"), has_corrected=True)
    for key, corrected, counts in ordered_map(correct, sections, progress.part(0.5, 1.0)):
        result.store.put(*key, corrected)
        after.add(counts, step)
    report = _report(before.counts, after.counts, table, by_scanner)
    report.beams = beams.count if beams else 0
    report.clipping = Clipping.of(before.counts[ACROSS].sum(axis=1), highest)
    if report.clipped:
        progress.warn(report.clipped)
    for line in report.lines()[:1]:
        progress.info(line)
    return result, report


def _step(road_points):
    """Of how many centimetres of road one is looked at for the level of asphalt; its points then stand for all of theirs."""
    length = sum(end - start for start, end in map(road_points.store.span, road_points.roads()))
    return max(int(len(road_points) / max(length, 1.0) / ENOUGH), 1)


def _stripes(points, step):
    """The points in every step-th centimetre of the road, the same ones however sections are cut."""
    s = points.records["s"]
    if step == 1 or not len(s):
        return points
    first = np.arange(s[0] // (STRIPE * step), s[-1] // (STRIPE * step) + 1) * (STRIPE * step)
    begins, ends = np.searchsorted(s, first), np.searchsorted(s, first + STRIPE)
    count = ends - begins
    return points[np.repeat(begins - (np.cumsum(count) - count), count) + np.arange(count.sum())]


def _by_scanner(points):
    """(256,) how many points each scanner has."""
    scanner = points.scanner
    return sum((np.bincount(scanner[k:k + AT_ONCE], minlength=256) for k in range(0, len(scanner), AT_ONCE)), np.zeros(256, np.int64))


def _why_not(road_points, frame):
    if not len(road_points):
        return "There are no road points whose intensity could be corrected."
    if not frame.has_time:
        return ("Intensity was left as it is: without gps_time in the cloud and time in the trajectory the distance "
                "from scanner to point is not known.")
    return ""


def _report(before, after, table, by_scanner):
    rows = table.told_by, np.arange(len(table.told_by))
    medians = [asphalt_of(counts[rows])[0] for counts in (before, after)]
    weight = before[rows].sum(axis=-1)
    known = table.known & np.isfinite(medians[0]) & np.isfinite(medians[1])
    report = IntensityReport("logarithmic" if table.logarithmic else "linear", table.reference)
    distances = np.abs(np.arange(weight.shape[1]) * BIN + BIN / 2 - REACH)
    for scanner in np.flatnonzero(known.any(axis=1)):
        use = known[scanner]
        row = dict(scanner=int(scanner), points=int(by_scanner[scanner]),
                   nearest=float(distances[use].min()), farthest=float(distances[use].max()))
        for name, levels in zip(("before", "after"), medians):
            mean, variation = _variation(levels[scanner, use], weight[scanner, use])
            row.update({f"asphalt_{name}": mean, f"spread_{name}": variation,
                        f"fall_{name}": float(levels[scanner, use].max() / max(levels[scanner, use].min(), 1e-9))})
        report.scanners.append(row)
    for name, levels in zip(("before", "after"), medians):
        means = [row[f"asphalt_{name}"] for row in report.scanners]
        setattr(report, f"between_{name}", max(means) / max(min(means), 1e-9))
        setattr(report, f"spread_{name}", _variation(levels[known], weight[known])[1])
    return report


def _variation(values, weights):
    """Weighted mean and coefficient of variation (%)."""
    mean = float((values * weights).sum() / weights.sum())
    return mean, float(100.0 * np.sqrt((weights * (values - mean) ** 2).sum() / weights.sum()) / max(abs(mean), 1e-9))
