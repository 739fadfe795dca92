"""What a run makes keeps its CRS after the thread that made it has nothing to do."""

import subprocess
import sys
from pathlib import Path

from qgis.core import QgsApplication

LATER = """
import sys, time
from qgis.core import QgsApplication, QgsCoordinateReferenceSystem, QgsTask
application = QgsApplication([], False)
application.initQgis()
sys.path.insert(0, {tests!r})
import conftest
from lanewright.processing_provider.provider import keep_task_threads
manager, made = application.taskManager(), []
manager.threadPool().setExpiryTimeout(100)
keep_task_threads()
task = QgsTask.fromFunction("run", lambda task: made.append(QgsCoordinateReferenceSystem("EPSG:32701")))
manager.addTask(task)
while not made or manager.countActiveTasks():
    application.processEvents()
time.sleep(1.5)
print(len(made[0].toWkt()) > 100, made[0].authid())
"""


def test_a_crs_that_a_run_made_is_whole_after_a_pause(provider):
    assert QgsApplication.taskManager().threadPool().expiryTimeout() == -1
    code = LATER.format(tests=str(Path(__file__).resolve().parents[1]))
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert run.stdout.split() == ["True", "EPSG:32701"], run.stderr
