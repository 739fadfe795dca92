"""Things of one kind kept as columns."""

from dataclasses import dataclass

import numpy as np
from lanewright.core.common.arrays import Rows


@dataclass
class Poles(Rows):
    place: np.ndarray
    height: np.ndarray


@dataclass
class Signs(Poles):
    text: np.ndarray


def test_some_of_the_signs_keep_their_columns_together_and_stay_signs():
    signs = Signs(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 5.0]]), np.array([2.1, 2.4, 3.0]), np.array(["A", "B", "C"]))
    assert len(signs) == 3
    tall = signs[signs.height > 2.2]
    assert isinstance(tall, Signs) and tall.text.tolist() == ["B", "C"] and tall.place.tolist() == [[1.0, 0.0], [2.0, 5.0]]
    assert signs[1:2].height.tolist() == [2.4]


def test_parts_of_a_street_are_joined_in_their_order():
    first, second = Poles(np.array([3.0]), np.array([2.0])), Poles(np.array([1.0, 2.0]), np.array([4.0, 5.0]))
    joined = Poles.join([first, second])
    assert joined.place.tolist() == [3.0, 1.0, 2.0] and joined.height.tolist() == [2.0, 4.0, 5.0]
