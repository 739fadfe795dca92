"""The sample survey of the menu leaves no files behind."""

import os
import subprocess
import sys
from pathlib import Path

ENDS_DURING_A_RUN = """
import os, sys
from qgis.testing import start_app
application = start_app()
sys.path.insert(0, {tests!r})
import conftest
from lanewright import classFactory
from lanewright.desktop.background import SampleRun
from qgis.core import QgsApplication
from qgis.gui import QgsMessageBar

class Window:
    bar = QgsMessageBar()
    def messageBar(self):
        return self.bar

plugin = classFactory(None)
plugin.initProcessing()
run = SampleRun(Window())
run.start()
print(run.folder.is_dir(), run.folder, flush=True)
tasks = QgsApplication.taskManager()
tasks.cancelAll()
for task in tasks.activeTasks():
    task.waitForFinished()
application.aboutToQuit.emit()
os._exit(0)  # how Qt takes down the rest is not the matter here
"""


def test_the_folder_of_the_sample_is_there_during_the_run_and_gone_when_qgis_ends(tmp_path):
    code = ENDS_DURING_A_RUN.format(tests=str(Path(__file__).resolve().parents[1]))
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, env={**os.environ, "TMPDIR": str(tmp_path)})
    assert run.returncode == 0, run.stderr
    there, folder = next(line for line in run.stdout.splitlines() if "lanewright-sample-" in line).split(" ", 1)
    assert there == "True" and Path(folder).is_relative_to(tmp_path)
    assert not Path(folder).parent.exists()
