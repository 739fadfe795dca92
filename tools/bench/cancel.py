"""How long Cancel takes: QGIS's own road map, all outputs wanted, cancelled at moments spread over the whole run.

    tools/bench.sh --parts cancel            30 moments on the dense survey, both boundary methods

Each run writes into a folder of its own, which must be empty afterwards. The moments are drawn
at random, one in each of as many equal shares of the run.
"""

import tempfile
import threading
import time
from pathlib import Path

import numpy as np

from .surveys import clouds_of, trajectory_of

MOMENTS = dict(full=30, quick=20)
FILES = dict(ROAD_EDGES="edges.gpkg", ROAD_SURFACE="surface.gpkg", MARKINGS="markings.gpkg", MARKING_LINES="lines.gpkg",
             DRIVING_LINES="driving.gpkg", CURVE_ELEMENTS="elements.gpkg", CURB_POINTS="curbs.gpkg", ROAD_POINTS="road.laz",
             INTENSITY_IMAGE="image.tif", REPORT="report.html")


def cancel(size):
    """Figures: how long a whole run took, and [(moment, seconds until it was over, last line of the log)]."""
    road_map = _road_map()
    whole, *_ = _run(road_map, size, None)
    moments = (np.arange(MOMENTS[size]) + np.random.default_rng(11).random(MOMENTS[size])) / MOMENTS[size] * whole
    waits, left = [], []
    for moment in moments.tolist():
        took, said, files = _run(road_map, size, moment)
        if took >= moment:  # else it was done before the moment came
            waits.append((moment, took - moment, said))
            left += files
    return dict(wall=whole, waits=waits, left=left)


def _road_map():
    """The algorithm, in a QGIS without a window."""
    from lanewright import classFactory
    from qgis.core import QgsApplication

    application = QgsApplication([], False)
    application.initQgis()
    plugin = classFactory(None)
    plugin.initProcessing()
    found = application.processingRegistry().createAlgorithmById("lanewright:roadmap")
    found.kept_alive = application, plugin
    return found


def _run(road_map, size, moment):
    """(seconds, last line of the log, files left behind) of a run that is cancelled after some seconds; never where None."""
    from qgis.core import QgsProcessingContext, QgsProcessingFeedback

    class Log(QgsProcessingFeedback):
        said = ""

        def pushInfo(self, text):
            self.said = text

    log = Log(False)
    with tempfile.TemporaryDirectory() as folder:
        values = dict(POINT_CLOUDS=[str(path) for path in clouds_of("dense", size)], TRAJECTORY=str(trajectory_of("dense", size)),
                      **{name: str(Path(folder) / file) for name, file in FILES.items()})
        timer = threading.Timer(moment, log.cancel) if moment is not None else None
        began = time.perf_counter()
        if timer:
            timer.start()
        _, fine = road_map.create().run(values, QgsProcessingContext(), log)
        took = time.perf_counter() - began
        if timer:
            timer.cancel()
        elif not fine:
            raise RuntimeError(f"The road map failed after: {log.said}")
        return took, log.said, [] if fine else [path.name for path in Path(folder).iterdir()]
