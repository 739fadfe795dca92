"""Makes what several tests share importable by the tests beside it, loads the algorithms, and ends what a test leaves in the window."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(autouse=True)
def nothing_is_left(qgis_app, provider):
    """After a test its windows are gone and nothing that it began runs on.

    A window whose buttons call lambdas about itself is never collected by Python: it would go on listening to the project of later tests. A
    legend that is filtered by its map is looked through in the background, where its layers may be gone before the end.
    """
    from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer, QEvent
    from qgis.PyQt.QtWidgets import QApplication

    before = set(QApplication.topLevelWidgets())
    yield
    tasks, clock = qgis_app.taskManager(), QElapsedTimer()
    tasks.cancelAll()
    clock.start()
    while tasks.countActiveTasks() and clock.elapsed() < 20_000:
        QCoreApplication.processEvents()
    for window in set(QApplication.topLevelWidgets()) - before:
        if window.parent() is None:
            window.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture
def window(qgis_app):
    """A dock beside a map of a road with two doubtful places; of the first, an edge was bridged and a lane inferred."""
    from doubtful_street import doubtful_window

    with doubtful_window() as dock:
        yield dock


@pytest.fixture
def at_first(window, tmp_path):
    """That dock at the first place, with a file for the corrections."""
    from doubtful_street import go_to_first

    go_to_first(window, tmp_path / "corrections.gpkg")
    return window
