"""Windows of paint that are worked on apart see the levels of asphalt of the whole road."""

from types import SimpleNamespace

import numpy as np
import pytest
from lanewright.core.markings.paint.asphalt_level import AsphaltBin, OtsuSplit
from lanewright.core.markings.paint.settings import MarkingSettings
from lanewright.core.markings.paint.windows import WindowExtractor, bins_about

SOURCE = SimpleNamespace(road_points=None, image=None, frame=None)


@pytest.mark.parametrize("empty", [0.0, 0.3, 0.8, 1.0])
@pytest.mark.parametrize("size", [1, 4])
def test_a_stretch_of_windows_has_the_levels_of_the_whole_road(empty, size):
    """Some windows have no level: all of a gap, or all windows of a noisy scanner."""
    rng, settings = np.random.default_rng(1), MarkingSettings()
    bins = {w: [] if rng.random() < empty else [(AsphaltBin(0.0, 600, float(w), 1.0), OtsuSplit(0.0, 1.0, 4.0, 0.0, 8.0, 0.1, bool(w % 2)))]
            for w in range(-3, 30)}
    whole = WindowExtractor(SOURCE, (0, -3, 30), settings, bins=bins)
    for first in range(-3, 30, size):
        stretch = 0, first, min(first + size, 30)
        own = WindowExtractor(SOURCE, stretch, settings, bins=bins_about(stretch, bins))
        for window in range(*stretch[1:]):
            known, found = whole._levels(window), own._levels(window)
            assert found.windows == known.windows and found._limits == known._limits
