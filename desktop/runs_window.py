"""A window of QGIS with the runs since it was started: one table for each algorithm."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProcessingUtils
from qgis.PyQt.QtCore import Qt, QUrl
from qgis.PyQt.QtGui import QDesktopServices
from qgis.PyQt.QtWidgets import QDialog, QDialogButtonBox, QTableWidget, QTableWidgetItem, QTabWidget, QWidget

from ..processing_provider.results.runs import run_table, run_tables
from ..processing_provider.texts import tr
from .widgets import column

SIZE = (1000, 420)  # px


class RunsWindow(QDialog):
    """The window; a click on a column's head sorts by it."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent, windowTitle=tr("Table of the runs"))
        self.tabs = QTabWidget()
        for title, head, rows in run_tables():
            self.tabs.addTab(_table(head, rows), title)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.addButton(tr("Open in the browser"), QDialogButtonBox.ButtonRole.ActionRole).clicked.connect(lambda checked=False: _in_browser())
        buttons.rejected.connect(self.reject)
        column(self, self.tabs, buttons)
        self.resize(*SIZE)


def _table(head, rows):
    table = QTableWidget(len(rows), len(head))
    table.setHorizontalHeaderLabels(head)
    table.setEditTriggers(QTableWidget.EditTrigger.NoEditTriggers)
    for row, values in enumerate(rows):
        for number, value in enumerate(values):
            item = QTableWidgetItem()
            item.setData(Qt.ItemDataRole.DisplayRole, value)  # numbers stay numbers, by which they are sorted
            table.setItem(row, number, item)
    table.setSortingEnabled(True)
    table.resizeColumnsToContents()
    return table


def _in_browser():
    path = QgsProcessingUtils.generateTempFilename("runs.html")
    Path(path).write_text(run_table(), encoding="utf-8")
    QDesktopServices.openUrl(QUrl.fromLocalFile(path))
