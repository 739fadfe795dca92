"""Streets whose lanes cannot be told from the width alone."""

import numpy as np
import pytest
import shapely
from lanewright.simulator.parts.materials import LABEL
from lanewright.simulator.parts.paint import hatched_area
from lanewright.simulator.survey import SampleSettings, make_sample_survey


def survey(scene, **settings):
    return make_sample_survey(SampleSettings(**{"scene": scene, "length": 100.0, "pulse_rate": 60_000.0, "rotation_rate": 100.0, **settings}))


def middles(sample, kind):
    """Station and offset of the middle of each true marking of a kind."""
    return [outline.mean(axis=0) for marking in sample.scene.paint.markings if marking.kind == kind for outline in marking.outlines()]


def track_offset(sample):
    x0, y0, _ = sample.settings.origin
    t = sample.trajectory
    return sample.scene.axis.locate(t.x - x0, t.y - y0, np.linspace(-15, sample.settings.length + 15, len(t)), steps=3)[1]


@pytest.mark.parametrize("scene, width", [("one-lane", 5.8), ("wide-lane", 7.0)])
def test_a_single_lane_has_arrows_in_its_middle_and_is_driven_there(scene, width):
    sample = survey(scene)
    edges = sorted(d for _, d in middles(sample, "edge line"))
    assert edges[1] - edges[0] == pytest.approx(width)
    arrows = middles(sample, "arrow")
    assert len(arrows) > 1 and np.abs([d for _, d in arrows]).max() < 0.01
    assert np.abs(track_offset(sample)).max() < 0.2
    assert [(row["lane"], row["direction"]) for _, row in sample.truth_driving_lines] == [(1, 1)]


def test_without_a_centre_line_and_driven_on_the_right_there_are_two_lanes():
    sample = survey("no-centre-line")
    assert set(sample.truth_markings.column("class")) == {"edge line"}
    assert np.abs(track_offset(sample) + 1.75).max() < 0.2
    offsets = {row["direction"]: sample.scene.lanes[k].offsets for k, (_, row) in enumerate(sample.truth_driving_lines)}
    np.testing.assert_allclose(offsets[1], -1.75)
    np.testing.assert_allclose(offsets[-1], 1.75)


def test_lanes_beside_a_hatched_island_run_between_its_border_and_the_edge_line():
    sample = survey("hatched-island")
    border = next(marking for marking in sample.scene.paint.markings if marking.line == 3)
    stations = np.linspace(border.start + 0.1, border.end - 0.1, 50)
    expected = (np.interp(stations, *np.transpose(border.places)) + 4.2) / 2
    for lane in sample.scene.lanes:
        np.testing.assert_allclose(-lane.direction * np.interp(stations, lane.stations, lane.offsets), expected, atol=1e-9)


def test_the_island_is_hatched_from_border_to_border_and_its_paint_is_where_the_truth_says():
    sample = survey("hatched-island")
    points = sample.points(noise=False)
    hatch = shapely.union_all([shapely.force_2d(g) for g, row in sample.truth_markings if row["class"] == "hatching"])
    inside = shapely.contains_xy(shapely.buffer(hatch, -0.01), points["x"], points["y"])
    ground = points["label"][inside]
    assert inside.sum() > 500 and np.isin(ground, [LABEL["paint"], LABEL["worn paint"]]).all()
    on_road = points[np.isin(points["label"], [LABEL["paint"], LABEL["worn paint"]]) & (np.abs(points["offset"]) < 1.1)]
    painted = shapely.union_all([shapely.force_2d(g) for g, _ in sample.truth_markings])
    assert shapely.contains_xy(shapely.buffer(painted, 0.01), on_road["x"], on_road["y"]).all()


def test_bars_of_a_hatched_area_stay_within_it():
    area = np.array([(0.0, 0.0), (10.0, -1.0), (20.0, -1.0), (20.0, 1.0), (10.0, 1.0)])
    bars = [shapely.Polygon(bar) for bar in hatched_area(area)]
    assert len(bars) > 10
    assert all(shapely.Polygon(area).buffer(1e-9).contains(bar) for bar in bars)
    assert shapely.union_all(bars).area / shapely.Polygon(area).area == pytest.approx(0.5 / 1.5, abs=0.05)


@pytest.mark.parametrize("scene", ["one-lane", "wide-lane", "no-centre-line", "hatched-island", "cycle-lanes"])
@pytest.mark.parametrize("length", [20.0, 45.0, 85.0, 250.0])
def test_a_street_of_any_length_has_truth_up_to_its_end_and_none_beyond(scene, length):
    sample = survey(scene, length=length)
    ends = [row["end_m"] for layer in (sample.truth_driving_lines, sample.truth_boundaries) for _, row in layer]
    assert max(ends) == pytest.approx(length) and all(row["end_m"] <= length + 1e-6 for _, row in sample.truth_markings)
