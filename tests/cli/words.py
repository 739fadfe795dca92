"""The words of a command line as qgis_process takes them, worked off in the QGIS of the tests.

A process of QGIS of its own takes two seconds to start. What an algorithm says, writes and refuses does not depend on it; the tests of
what does (paths of the folder one calls from, standard output, exit code, signals) start the real one.
"""

import os
import shutil
from subprocess import CompletedProcess

# Left out of copies of surveys that several tests share: SQLite's files of those that read the GeoPackage at that moment.
OPEN_ELSEWHERE = shutil.ignore_patterns("*-shm", "*-wal")


def call(*words, folder):
    """`qgis_process run` of these words, called in `folder`: exit code, what was said and complained of, `results`."""
    from qgis.core import QgsApplication, QgsProcessingContext, QgsProcessingFeedback

    class Log(QgsProcessingFeedback):
        def __init__(self):
            super().__init__(False)
            self.said, self.complaints = [], []

        def pushInfo(self, text):
            self.said.append(text)

        setProgressText = pushWarning = pushInfo

        def reportError(self, text, fatalError=False):
            self.complaints.append(text)

    run, name, *given = words
    assert run == "run"
    algorithm, log, context = QgsApplication.processingRegistry().createAlgorithmById(name), Log(), QgsProcessingContext()
    context.setFeedback(log)
    before = os.getcwd()
    os.chdir(folder)
    try:
        fine, refused = algorithm.checkParameterValues(values(given), context)
        if fine:
            results, fine = algorithm.run(values(given), context, log, {}, True)
        else:
            log.reportError(refused)
    finally:
        os.chdir(before)
    done = CompletedProcess(words, 0 if fine else 1, "\n".join(log.said), "\n".join(log.complaints))
    done.results = results if fine else {}
    return done


def values(words):
    """Parameters by name; one that is given several times is a list."""
    found = {}
    for word in words:
        name, _, value = word.removeprefix("--").partition("=")
        found[name] = value if name not in found else [*(found[name] if isinstance(found[name], list) else [found[name]]), value]
    return found
