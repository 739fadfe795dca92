"""Lanes that are cut askew keep their corners and heights; edges of the pavement stay what they are."""

import numpy as np
import pytest
from lanewright.core.export.check.roads import check_opendrive
from lanewright.core.export.fit_of_export import border_misses
from lanewright.core.export.opendrive.exporter import draft_opendrive
from lanewright.core.export.opendrive.layers import layers_of_opendrive
from lanewright.core.export.opendrive.reader import read_opendrive
from lanewright.core.export.opendrive.writer import opendrive_text
from lanewright.core.export.sources import RoadMapSource, checked
from made_lanes import CRS, Axis, LaneScene, kinds
from map_files import written

TOLERANCE = 0.02   # m


def askew(scene, line, left, right, first, last, shift, step=1.0, **values):
    """A piece whose cross-sections run askew: a border lies `shift` metres behind for every metre to the right."""
    s = np.arange(first, last + step / 2, step)
    scene.piece(*(line.at(s + shift * side, side) for side in (left, right)), **values)


def missed(folder, lanes):
    whole = read_opendrive(written(folder, opendrive_text(draft_opendrive(checked(RoadMapSource(lanes))).map)))
    across, rise = border_misses(lanes, layers_of_opendrive(whole, CRS).lanes)
    assert across.places == 2 * len(lanes.left)
    return whole, across.largest, rise.largest


@pytest.mark.parametrize("shift", [-0.6, -0.2, 0.2, 0.6])
@pytest.mark.parametrize("pieces", [((60.0, 0.0, 0.0),), ((60.0, 1 / 80, 1 / 80),)], ids=["straight", "curve"])
def test_a_road_that_is_cut_askew_keeps_its_corners(tmp_path, shift, pieces):
    scene, line = LaneScene(), Axis(((5.0, 0.0, 0.0), *pieces, (5.0, 0.0, 0.0)), slope=0.08, crown=0.02)
    askew(scene, line, 0.0, -3.5, 5.0, 60.0, shift, lane=1, **kinds())
    askew(scene, line, -3.5, -7.0, 5.0, 60.0, shift, lane=2)
    whole, across, rise = missed(tmp_path, scene.lanes())
    assert across <= TOLERANCE and rise <= TOLERANCE
    assert len(whole.roads) == 1 and whole.roads[0].length == pytest.approx(55.0 + 7.0 * abs(shift), abs=0.5) and not check_opendrive(whole).found


@pytest.mark.parametrize("shift", [-0.5, 0.5])
def test_a_lane_that_begins_and_ends_obliquely_is_whole(tmp_path, shift):
    scene, line = LaneScene(), Axis(((140.0, 0.0, 0.0),), slope=0.06)
    for piece, (first, last) in enumerate(((0, 40), (40, 100), (100, 140)), start=1):
        scene.add(line, 0.0, -3.5, first, last, lane=1, piece=piece)
    s = np.arange(40.0, 100.5)
    # the last 10 m of its outer border at both ends are longer or shorter by 3.5 m times the shift
    outer = np.interp(s, [40.0, 50.0, 90.0, 100.0], [40.0 + 3.5 * shift, 50.0, 90.0, 100.0 - 3.5 * shift])
    scene.piece(line.at(s, -3.5), line.at(outer, -7.0), lane=2)
    _, across, rise = missed(tmp_path, scene.lanes())
    assert across <= TOLERANCE and rise <= TOLERANCE
