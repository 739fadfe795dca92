"""Paint that few scan lines meet, far off or beside a fast vehicle."""

import numpy as np
import pytest
from clustered_marks import FRAME, classes, layer_of
from painted_streets import between, paint, records_at, road_points, strip


def sparse(records, across=0.20, along=0.13):
    """The records that a scanner far off would leave: tracks 20 cm apart across the road, a point every 13 cm on each."""
    on_track = (records["d"] * 1e-4 / across % 1.0 < 0.06) & (records["s"] * 1e-4 / along % 1.0 < 0.15)
    records = records[on_track]
    records["spacing"] = int(across * 1000)
    return records


def bars(count, turn=1.0):
    """Bars of hatching, 1 m by 3 m and 2.5 m apart, oblique to the road."""
    def on(s, d):
        phase = s + turn * (d - 2.0) - 20.0
        return (d >= 2.0) & (d < 5.0) & (phase % 2.5 < 1.0) & (phase >= 0) & (phase < 2.5 * count)
    return between(17, 20 + 2.5 * count, on)


def test_hatching_far_off_keeps_its_bars():
    records = sparse(paint(FRAME, [bars(6)], density=20000, length=40.0))
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert classes(markings) == ["hatch"] * 6
    assert sum(markings.column("area_m2")) == pytest.approx(6 * 3.0, rel=0.3)


def test_a_broad_line_far_off_is_one_line_as_wide_as_it_is():
    # the line leaves the tracks slowly, as every road does, so that each shows it at another place of its width
    def line(s, d):
        return (s >= 10) & (s < 70) & (d >= 3.0 + 0.02 * s) & (d < 3.3 + 0.02 * s)

    markings, _ = layer_of(road_points(sparse(paint(FRAME, [between(10, 70, line)], density=20000, reach=5.0)), FRAME), FRAME)
    longest = max(markings.rows, key=lambda row: row["length_m"])
    assert longest["length_m"] == pytest.approx(60.0, abs=3.0)
    assert longest["width_m"] == pytest.approx(0.30, abs=0.08)
    assert longest["area_m2"] > 0.95 * sum(markings.column("area_m2"))


def test_points_as_far_apart_that_were_scanned_densely_are_not_joined():
    records = sparse(paint(FRAME, [bars(6)], density=20000, length=40.0))
    records["spacing"] = 0
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert "hatch" not in classes(markings)


def test_a_line_that_every_scan_line_meets_once_is_a_line():
    rng = np.random.default_rng(4)
    s = np.arange(10.0, 30.0, 0.28)
    records = records_at(FRAME, s, rng.uniform(-3.15, -3.0, len(s)), np.full(len(s), 4000.0), 6.0)
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert set(classes(markings)) <= {"lane", "centre"}
    assert sum(markings.column("length_m")) > 15.0


def test_a_long_line_so_far_off_that_its_width_cannot_be_told_is_a_line():
    s = np.arange(5.0, 60.0, 0.1)
    records = records_at(FRAME, s, 5.5 + 0.02 * np.sin(7 * s), np.full(len(s), 4000.0), 6.0)
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert set(classes(markings)) == {"edge"}
    assert markings.rows[0]["width_m"] < 0.06


def test_the_bright_face_of_a_curb_far_off_is_no_edge_line():
    face = paint(FRAME, [strip(10, 70, 5.93, 6.0)], density=20000, reach=6.0)
    face = face[face["s"] * 1e-4 / 0.13 % 1.0 < 0.15]
    # two tracks of the scan meet it in turns
    face["d"] -= np.where(face["s"] * 1e-4 % 8.0 < 4.0, 0, 800).astype(np.int32)
    face["spacing"] = 200
    markings, _ = layer_of(road_points(face, FRAME), FRAME)
    assert len(markings) == 0


@pytest.mark.parametrize(("spacing", "gap", "pieces"), [(200, 1.5, 1), (0, 1.5, 8), (200, 3.0, 8)], ids=["tracks apart", "dense scan", "dashes"])
def test_a_line_that_tracks_cross_oblique_shows_on_each_for_a_while(spacing, gap, pieces):
    """Between two tracks it was not seen; where tracks lie close together, or gaps are long, there is none."""
    marks = [strip(10 + k * (1.5 + gap), 11.5 + k * (1.5 + gap), 2.0, 2.12) for k in range(8)]
    records = paint(FRAME, marks)
    records["spacing"] = spacing
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert len(markings) == pieces


def crossed(slope, period, on=1.2, count=6, middle=3.0, width=0.12):
    """Records of a line that one track of the scan after the other crosses from side to side, `on` m each."""
    along = np.concatenate([10 + k * period + np.arange(0.0, on, 0.06) for k in range(count)])
    across = middle + np.clip(slope * ((along - 10) % period - on / 2), -width / 2, width / 2)
    return records_at(FRAME, along, across, np.full(len(along), 4000.0), 6.0)


@pytest.mark.parametrize(("slope", "period", "pieces"), [(0.1, 4.0, 1), (0.0, 4.0, 6), (0.1, 6.0, 6)],
                         ids=["tracks leave it sideways", "it ends beneath a track", "too far"])
def test_a_line_goes_on_where_the_track_left_it_sideways(slope, period, pieces):
    records = crossed(slope, period)
    records["spacing"] = 300
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert len(markings) == pieces


def test_an_edge_line_one_track_from_a_bright_curb_is_not_joined_to_it():
    line, curb = strip(10, 50, 5.6, 5.72), strip(10, 50, 5.95, 6.0)
    records = paint(FRAME, [line, curb], density=20000, length=55.0)
    records["spacing"] = 300
    markings, _ = layer_of(road_points(records, FRAME), FRAME)
    assert classes(markings) == ["edge"]
    assert markings.rows[0]["width_m"] == pytest.approx(0.12, abs=0.04)
