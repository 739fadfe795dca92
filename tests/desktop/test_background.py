"""What runs in the background outlives the window that began it."""

import gc

from lanewright.desktop.background import BackgroundRun
from qgis.PyQt.QtCore import QCoreApplication, QElapsedTimer


def test_a_run_that_its_window_forgets_keeps_what_it_works_with_until_it_ends(provider, tmp_path):
    ended, clock = [], QElapsedTimer()
    run = BackgroundRun("samplesurvey", {"LENGTH": 20.0, "POINT_CLOUD": str(tmp_path / "s.laz"), "TRAJECTORY": str(tmp_path / "drive.gpkg")},
                        lambda run, fine: ended.append(fine))
    del run
    gc.collect()   # without feedback and context the run, and QGIS with it, would end by a fault of memory
    clock.start()
    while not ended and clock.elapsed() < 60_000:
        QCoreApplication.processEvents()
    assert ended == [True] and (tmp_path / "s.laz").exists()
