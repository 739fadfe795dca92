"""Windows of paint that one process works on share what they compute, and no more of it is kept than is needed."""

from types import SimpleNamespace

import pytest
from lanewright.core.markings.paint import windows
from lanewright.core.markings.paint.settings import MarkingSettings
from lanewright.core.markings.paint.windows import THRESHOLD_WINDOW, WindowExtractor
from lanewright.core.survey.store.records import ROAD_POINT
from lanewright.core.survey.store.section_store import SectionStore


@pytest.mark.parametrize("stretches", [[range(90)], [range(70, 82), range(12), range(40, 52)]])
def test_a_road_of_any_length_has_the_data_of_few_windows_in_memory(monkeypatch, stretches):
    store, read, looked = SectionStore(ROAD_POINT), [], []
    road_points = SimpleNamespace(store=store, window=store.window, has_corrected=False)
    monkeypatch.setattr(windows, "cells_of_road", lambda points, road, first, last, step: read.append(first // THRESHOLD_WINDOW) or ["a piece"])
    monkeypatch.setattr(WindowExtractor, "_view", lambda self, window: [self._in_cells(number) for number in (window - 1, window, window + 1)])
    monkeypatch.setattr(WindowExtractor, "_bins_of", lambda self, window, view: [window])
    monkeypatch.setattr(windows, "AsphaltLevels", lambda bins, *_: looked.append(list(bins)) or SimpleNamespace(numbers=[]))
    extractor = WindowExtractor(SimpleNamespace(road_points=road_points, image=None, frame=None), 0, range(90), MarkingSettings())
    for stretch in stretches:
        for window in stretch:
            extractor.extract(window)
            assert len(extractor._pieces) + len(extractor._views) <= 4 * windows.WINDOWS_KEPT
    assert looked == [[w, *(n for n in (w - 1, w - 2, w + 1, w + 2) if 0 <= n < 90)] for stretch in stretches for w in stretch]
    if len(stretches) == 1:
        assert len(read) == len(set(read)), "each is read once where windows follow each other"
