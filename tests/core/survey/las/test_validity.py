"""Points that whoever made the cloud marked as none of the survey."""

import laspy
import numpy as np
import pytest
from drives import EAST, NORTH
from lanewright.core.survey.blocks import DECODED_LAYERS
from lanewright.core.survey.las.point_fields import valid_points
from lanewright.core.survey.las.reader import read_blocks

ROAD, LOW_NOISE, VEGETATION, HIGH_NOISE = 11, 7, 5, 18


def block_of(path, classes, withheld, point_format):
    """The points of a file, as a survey is read."""
    cloud = laspy.create(point_format=point_format, file_version="1.4" if point_format >= 6 else "1.2")
    cloud.header.offsets, cloud.header.scales = [EAST, NORTH, 0.0], [0.001] * 3
    cloud.x, cloud.y, cloud.z = EAST + np.arange(len(classes)), np.full(len(classes), NORTH), np.full(len(classes), 100.0)
    cloud.classification, cloud.withheld = classes, withheld
    cloud.write(str(path))
    block, = read_blocks(path, layers=DECODED_LAYERS)
    return block


@pytest.mark.parametrize("suffix", ["las", "laz"])
@pytest.mark.parametrize("point_format", [1, 6])
def test_withheld_points_and_both_classes_of_noise_are_left_out_whatever_else_a_cloud_holds(tmp_path, point_format, suffix):
    classes, withheld = [ROAD, LOW_NOISE, VEGETATION, HIGH_NOISE, ROAD, 0, LOW_NOISE], [0, 0, 0, 0, 1, 0, 1]
    block = block_of(tmp_path / f"cloud.{suffix}", classes, withheld, point_format)
    assert valid_points(block).tolist() == [True, False, True, False, False, True, False]


@pytest.mark.parametrize("point_format", [1, 6])
def test_of_a_cloud_that_marks_none_all_points_are_taken(tmp_path, point_format):
    assert valid_points(block_of(tmp_path / "cloud.laz", [ROAD, 0, 2], [0, 0, 0], point_format)) is None
