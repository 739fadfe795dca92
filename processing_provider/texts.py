"""Translation of what the user reads."""

from pathlib import Path

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QCoreApplication, QTranslator

from ..algorithms.texts import set_translation, tr
from ..core.common.texts import CoreMessages

__all__ = ["install_translator", "remove_translator", "told", "tr"]

CONTEXT = "Lanewright"
TRANSLATIONS = Path(__file__).resolve().parents[1] / "resources" / "i18n"

_core = CoreMessages({})


def _translate(text):
    return QCoreApplication.translate(CONTEXT, text)


def told(message):
    """What the core says, in the user's language."""
    return _core.told(message)


set_translation(_translate, told)


def chosen_language():
    """The language of QGIS: that of its command line (--lang), else that of its settings or of the system."""
    application = QgsApplication.instance()
    return (application.translation() if isinstance(application, QgsApplication) else "") or QgsApplication.locale()


def install_translator(locale=""):
    """Speak the language of QGIS where there is a translation; the translator, for its owner to keep.

    Labels stand in classes and tables, so this comes before those are imported.
    """
    global _core
    language = (locale or chosen_language())[:2]
    _core = CoreMessages.load(TRANSLATIONS / f"core_{language}.json", tr)
    translator = QTranslator()
    if not translator.load(str(TRANSLATIONS / f"lanewright_{language}.qm")):
        return None
    QCoreApplication.installTranslator(translator)
    set_translation(_translate, told, language)
    return translator


def remove_translator(translator):
    global _core
    _core = CoreMessages({})
    set_translation(_translate, told)
    if translator is not None:
        QCoreApplication.removeTranslator(translator)
