"""The threads in which QGIS runs algorithms, kept alive."""

from qgis.core import QgsApplication


def keep_task_threads() -> None:
    """Let the threads of QGIS's task manager wait for the next run for as long as QGIS runs; by default one ends after 30 s without work.

    With a thread ends its PROJ context, and every QgsCoordinateReferenceSystem that was first made in it, or that QGIS has cached from it since,
    loses its definition: it still says EPSG:32650 and that it is valid, but its WKT is empty (seen in 3.40.6 and 3.44.15). The layers of a run
    would then be saved and exported without their CRS, and the next run would find none.
    """
    manager = QgsApplication.taskManager()
    if hasattr(manager, "threadPool"):
        manager.threadPool().setExpiryTimeout(-1)
