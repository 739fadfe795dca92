"""Says which Python packages are missing, with the command that installs them ready to be copied."""

from qgis.core import Qgis, QgsApplication, QgsMessageOutput
from qgis.PyQt.QtWidgets import QPushButton

from ..processing_provider.dependencies import how_to_install, install_command, missing_in_short
from ..processing_provider.texts import tr


def all_is_there(iface) -> bool:
    """Whether no package is missing; else the message bar says which one, in one short sentence."""
    missing = missing_in_short()
    if not missing:
        return True
    said = iface.messageBar().createMessage("Lanewright", missing)
    copy = QPushButton(tr("Copy command"))
    copy.setToolTip(install_command())
    copy.clicked.connect(lambda checked=False: QgsApplication.clipboard().setText(install_command()))
    more = QPushButton(tr("How to install…"))
    more.clicked.connect(lambda checked=False: _explain())
    for button in (copy, more):
        said.layout().addWidget(button)
    iface.messageBar().pushWidget(said, Qgis.MessageLevel.Warning)
    return False


def _explain():
    window = QgsMessageOutput.createMessageOutput()
    window.setTitle("Lanewright")
    window.setMessage(how_to_install(), Qgis.StringFormat.PlainText)
    window.showMessage()
