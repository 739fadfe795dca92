"""Translation of what the user reads."""

from pathlib import Path

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QCoreApplication, QTranslator

from ..algorithms.texts import set_translation, tr

__all__ = ["install_translator", "remove_translator", "tr"]

CONTEXT = "Lanewright"
TRANSLATIONS = Path(__file__).resolve().parents[1] / "resources" / "i18n"


def _translate(text):
    return QCoreApplication.translate(CONTEXT, text)


set_translation(_translate)


def chosen_language():
    """The language of QGIS: that of its command line (--lang), else that of its settings or of the system."""
    application = QgsApplication.instance()
    return (application.translation() if isinstance(application, QgsApplication) else "") or QgsApplication.locale()


def install_translator(locale=""):
    """Speak the language of QGIS where there is a translation; the translator, for its owner to keep.

    Labels stand in classes and tables, so this comes before those are imported.
    """
    language = (locale or chosen_language())[:2]
    translator = QTranslator()
    if not translator.load(str(TRANSLATIONS / f"lanewright_{language}.qm")):
        return None
    QCoreApplication.installTranslator(translator)
    return translator


def remove_translator(translator):
    if translator is not None:
        QCoreApplication.removeTranslator(translator)
