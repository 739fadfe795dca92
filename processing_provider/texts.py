"""What the user reads, in the language of QGIS."""

from qgis.core import QgsApplication

from ..algorithms.texts import numbers, retold, speak, told, tr

__all__ = ["chosen_language", "numbers", "retold", "speak", "told", "tr"]


def chosen_language():
    """The language of QGIS: that of its command line (--lang), else that of its settings or of the system."""
    application = QgsApplication.instance()
    return (application.translation() if isinstance(application, QgsApplication) else "") or QgsApplication.locale()
