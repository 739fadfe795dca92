"""The Lanewright menu and its button in the plugin toolbar: what a user reaches without opening the toolbox; and the window of the manual."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qgis.core import Qgis, QgsApplication, QgsMapLayer, QgsProcessingModelAlgorithm, QgsProcessingUtils, QgsProject
from qgis.PyQt.QtCore import QObject, Qt, QUrl, pyqtSlot
from qgis.PyQt.QtGui import QAction, QDesktopServices, QIcon, QPixmap, QTextDocument
from qgis.PyQt.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QMainWindow,
    QMenu,
    QTableWidget,
    QTableWidgetItem,
    QTabWidget,
    QTextBrowser,
    QToolBar,
    QWidget,
)

from ..algorithms.destinations import destination_path
from ..algorithms.export import DRAWN
from ..core.execution.kept_run import WINDOW
from ..processing_provider.results.road_maps import (
    NAMES_ONLY,
    REPLACES_LAST_RUN,
    RoadMap,
    last_report,
    last_run,
    road_maps,
    run_table,
    run_tables,
)
from ..processing_provider.styling import say_in_users_language
from ..processing_provider.texts import chosen_language, tr
from .background import SampleRun
from .widgets import all_is_there, column, open_file, say

ICON = Path(__file__).resolve().parents[1] / "resources" / "icon.svg"


class Menu(QObject):
    """Adds its actions on creation; `remove` takes them away again."""

    def __init__(self, iface):
        super().__init__()
        self.iface = iface
        self.actions = []
        self.dialog = self.designer = None  # kept, or Python would collect the open windows
        self.section = self.doubts = self.pairs = self.swipe = None
        WINDOW.wanted = True
        self.sample = SampleRun(iface)
        self.manual = ManualWindow(iface.mainWindow())
        theme = QgsApplication.getThemeIcon
        self._add(tr("Road map…"), self.open_road_map, tr("From a survey to driving lines in one call"), QIcon(str(ICON)))
        self._add(tr("Run the sample survey"), self.sample.start, tr("A simulated street through the whole chain, into this project"),
                  theme("/mActionStart.svg"))
        self._add(tr("Sheets along the road…"), self.open_layout, tr("The road map on paper: plan sheets, profile and cross-sections as one PDF"),
                  theme("/mActionNewLayout.svg"))
        self._add(tr("Next doubtful place"), self.next_doubt, tr("Goes along the road map through pieces that were not measured, that are uncertain, "
                  "or where the boundary methods differ, and keeps what you decide there"), theme("/mActionZoomNext.svg"))
        self._add(tr("Steps of the road map"), lambda: self.next_doubt(steps=True), tr(
            "The stages of the road map in their order, whether each still holds, its settings, and running it again"), theme("/mActionRefresh.svg"))
        self._add(tr("Cross-section"), self.open_section, tr("Points and lines of the road where you click in the map"),
                  theme("/mActionElevationProfile.svg"))
        self._add(tr("Road map in 3D"), self.open_3d,
                  tr("QGIS's 3D view over the middle of the map, with curbs, paint and driving lines at their heights"),
                  theme("/mActionNew3DMap.svg"))
        self._add(tr("Compare two images"), self.compare, tr("Orthoimage or web map left of the mouse, intensity image right of it, lines on both"),
                  theme("/mActionSplitFeatures.svg"))
        self._add(tr("Photos along the road…"), lambda: self.open_algorithm("native:importphotos", {}), tr(
            "A layer of the places of photos, by their EXIF data; the doubtful places show the photo that looks at them. "
            "A CSV layer with a column of file names does as well"), theme("/mActionAddImage.svg"))
        self._add(tr("Control points from paint"), self.open_pairs, tr("Places UAV images on the map: the same paint in each and in the intensity "
                  "image, side by side to accept or refuse"), QIcon(str(ICON.parent / "icons" / "proposecontrolpoints.svg")))
        self._add(tr("Open the last report"), self.open_report, tr("The report of the run that ended last"), theme("/mIconHtml.svg"))
        self._add(tr("Table of the runs"), self.open_table, tr("Lengths, shares measured, warnings, seconds and failures of all runs since QGIS "
                  "was started"), theme("/mActionOpenTable.svg"))
        self._add_models()
        self._add_choice(tr("Replace the last run of a survey"), REPLACES_LAST_RUN,
                         tr("New results take the place of the last ones of the same survey and algorithm in the layer tree; files stay"))
        self._add_choice(tr("Name files without their folders"), NAMES_ONLY,
                         tr("Results keep the names of the files they were made from, but not the folders; for layers that are given away"))
        self._add(tr("Manual"), self.manual.open, tr("What every algorithm does, and a walk through a first survey"),
                  theme("/mActionHelpContents.svg"))
        # QGIS asks when it shows the menu of a layer: only then is it known what the layer is
        iface.layerTreeView().contextMenuAboutToShow.connect(self._fill_layer_menu)
        QgsProject.instance().layersAdded.connect(say_in_users_language)   # also those of a colleague, from a file in another language
        # A toolbar of its own would take a row of the window for one button
        iface.addToolBarIcon(self.actions[0])

    def _add(self, title, what, tip, icon=QIcon()):
        action = QAction(icon, title, self.iface.mainWindow(), toolTip=f"Lanewright: {tip}", statusTip=tip, triggered=lambda checked=False: what())
        self.iface.addPluginToMenu("Lanewright", action)
        self.actions.append(action)
        return action

    def _add_choice(self, title, setting, tip):
        """An entry with a tick, which is a setting of the user."""
        action = self._add(title, lambda: None, tip)
        action.setCheckable(True)
        action.setChecked(setting.holds())
        action.toggled.connect(setting.keep)

    def _add_models(self):
        """A sub-menu that opens the models of the plugin in QGIS's model designer, each as a copy to be changed and saved."""
        menu = QMenu(tr("Open a model in the designer"), self.iface.mainWindow())
        menu.setIcon(QgsApplication.getThemeIcon("/processingModel.svg"))
        provider = QgsApplication.processingRegistry().providerById("lanewright")
        for algorithm in provider.algorithms() if provider else ():
            if isinstance(algorithm, QgsProcessingModelAlgorithm):
                menu.addAction(algorithm.displayName(), lambda checked=False, name=algorithm.id(): self.open_model(name))
        self.models = menu
        self.iface.addPluginToMenu("Lanewright", menu.menuAction())
        self.actions.append(menu.menuAction())

    def open_model(self, name):
        """The designer with a copy of a model."""
        from processing.modeler.ModelerDialog import ModelerDialog

        self.designer = ModelerDialog.create(QgsApplication.processingRegistry().createAlgorithmById(name))
        self.designer.show()

    def open_section(self):
        """The cross-section window, with the map waiting for a click; at the doubtful place that is looked at, its section."""
        if not all_is_there(self.iface):
            return
        if self.section is None:
            from .review.section_dock import SectionDock

            self.section = SectionDock(self.iface)
            self.section.corrected.connect(lambda: self.doubts.corrected() if self.doubts is not None else None)
        self.section.show()
        self.section.pick.click()
        if self.doubts is not None and self.doubts.isVisible() and self.doubts.seen is not None:
            self._show_section(self.doubts.seen)

    def open_pairs(self):
        """The window that places UAV images by paint; what was found in it is there again when it is opened again."""
        if not all_is_there(self.iface):
            return
        if self.pairs is None:
            from .overlay.pairs_dialog import PairsDialog

            self.pairs = PairsDialog(self.iface)
        self.pairs.show()
        self.pairs.raise_()

    def compare(self):
        """Two images of the project, divided by a line under the mouse, until another tool of the map is taken."""
        from .overlay.swipe import Swipe, images_to_compare

        images = images_to_compare(QgsProject.instance(), self.iface.activeLayer())
        if len(images) < 2:
            say(self.iface, tr("Two images are needed: the intensity image of a road map, and an orthoimage or web map. Add one to the project."))
            return
        self.swipe = self.swipe or Swipe(self.iface.mapCanvas())
        self.swipe.begin(images)
        say(self.iface, tr("Left of the mouse: {left}; right of it: {right}. Esc or another tool ends it.").format(
            left=images[0].name(), right=images[1].name()))

    def next_doubt(self, steps=False):
        """The next doubtful place of the road map of the active layer, else of the newest, or the list of its steps."""
        maps = self._road_maps()
        if not maps or not all_is_there(self.iface):
            return
        if self.doubts is None:
            from .review.doubt_dock import DoubtDock

            self.doubts = DoubtDock(self.iface)
            self.doubts.shown.connect(self._show_section)
            self.doubts.made_again.connect(lambda road_map: self.section.goes_on_in(road_map) if self.section is not None else None)
            self.doubts.steps.run_wanted.connect(lambda: self.run_again(self.doubts.road_map, self.doubts.layer))
            self.doubts.steps.stage_wanted.connect(self.open_algorithm)
        (self.doubts.show_steps if steps else self.doubts.go)(maps[0])

    def _road_maps(self):
        """The road maps of the project; where there are none, a word on that."""
        maps = road_maps(QgsProject.instance(), self.iface.activeLayer())
        if not maps:
            say(self.iface, tr("There is no road map in this project yet: run Road map, or drop the GeoPackage of one into the project."))
        return maps

    def _show_section(self, place):
        """The section at a doubtful place, where its window is open."""
        if self.section is not None and self.section.isVisible():
            self.section.show_at(place.middle, place.crs)

    def run_again(self, road_map, corrections):
        """Road map with all that a road map was made from, and the corrections made in it, if any."""
        from .review.steps import saved, values_again

        self.open_road_map(**values_again(road_map, corrections))
        places = saved(road_map)
        folders = [path.parent for path in map(destination_path, places.values()) if path is not None]
        if folders and self.dialog is not None:
            self.dialog.say_places(str(folders[0]), places)

    def _fill_layer_menu(self, menu):
        """"Run this stage again" for a layer of ours."""
        from .dialogs.stage_inputs import stage_again

        layer = self.iface.layerTreeView().currentLayer()
        stage = None if layer is None else stage_again(layer, QgsProject.instance())
        if stage is not None:
            menu.addAction(QIcon(str(ICON)), tr("Run this stage again…"), lambda: self.open_algorithm(*stage))

    def open_report(self):
        """The report written last, in the user's web browser."""
        path = last_report()
        if path:
            open_file(self.iface, path)
        else:
            say(self.iface, tr("No report has been written since QGIS was started."))

    def open_table(self):
        """What the runs since QGIS was started gave, in a window."""
        if last_run() is None:
            say(self.iface, tr("Nothing has been run since QGIS was started."))
            return
        self.dialog = RunsWindow(self.iface.mainWindow())
        self.dialog.show()

    def remove(self):
        self.iface.layerTreeView().contextMenuAboutToShow.disconnect(self._fill_layer_menu)
        QgsProject.instance().layersAdded.disconnect(say_in_users_language)
        self.iface.removeToolBarIcon(self.actions[0])
        for action in self.actions:
            self.iface.removePluginMenu("Lanewright", action)
        self.actions = []
        for dock in (self.section, self.doubts):
            if dock is not None:
                dock.remove()
        self.section = self.doubts = None
        if self.pairs is not None:
            self.pairs.close()
            self.pairs.deleteLater()
            self.pairs = None
        if self.swipe is not None:
            self.swipe.end()
        self.manual.forget()
        WINDOW.end()

    def open_road_map(self, **values):
        self.open_algorithm("lanewright:roadmap", values)

    def open_algorithm(self, name, values):
        from qgis import processing

        self.dialog = processing.createAlgorithmDialog(name, values)
        if self.dialog is not None:  # QGIS has said why
            self.dialog.show()

    def open_3d(self):
        """QGIS's 3D view of the road map of the active layer, else of the newest; where QGIS has none, a word on that."""
        maps = self._road_maps()
        if not maps:
            return
        try:
            from .view3d import show_in_3d

            fine = show_in_3d(self.iface, maps[0], maps[0].title)
        except ImportError:  # a QGIS that was built without 3D
            fine = False
        if not fine:
            say(self.iface, tr("This QGIS opened no 3D view. It needs a graphics driver and a projected CRS of the project."))

    def open_layout(self):
        """The dialog of Sheets along the road, for the road map of the active layer, else the newest."""
        maps = self._road_maps()
        if maps:
            self.open_algorithm("lanewright:printsheets", sheet_values(maps[0], maps, QgsProject.instance()))


# What of a project belongs on the sheets of a road map: its layers that are switched on, and the image below them with its credit.

def shown_layers(road_map: RoadMap, project: QgsProject, hidden: bool = False) -> list[QgsMapLayer]:
    """Layers of a road map, and others in its group, that have a place on the map, from above; those that are switched off only with `hidden`."""
    inside = {node.layerId() for node in road_map.group.findLayers()} if road_map.group is not None else set()
    inside |= {layer.id() for layer in road_map.layers}
    return [node.layer() for node in project.layerTreeRoot().findLayers()
            if node.layerId() in inside and node.layer() and node.layer().isSpatial() and (hidden or node.itemVisibilityChecked())]


def layers_below(project: QgsProject, maps: list[RoadMap]) -> list[QgsMapLayer]:
    """Images and web maps of a project that are no part of a road map, from above."""
    inside = {layer.id() for road_map in maps for layer in shown_layers(road_map, project, hidden=True)}
    nodes = project.layerTreeRoot().findLayers()
    return [node.layer() for node in nodes if node.layer() and node.layer().id() not in inside and node.layer().isSpatial()
            and node.layer().type() not in (Qgis.LayerType.Vector, Qgis.LayerType.PointCloud)]


def credit_of(layer: QgsMapLayer) -> str:
    """Whose data a layer shows, by its metadata or by its server; "" where neither says so."""
    return ", ".join(layer.metadata().rights()) or layer.serverProperties().attribution()


def sheet_values(road_map: RoadMap, maps: list[RoadMap], project: QgsProject) -> dict[str, Any]:
    """{parameter: value} of Sheets along the road for a road map: what is switched on (all where nothing is), over the image that is seen."""
    shown = shown_layers(road_map, project) or list(road_map.layers)
    values: dict[str, Any] = {output: layer.id() if layer in shown else None for output, layer in zip(road_map.outputs, road_map.layers)}
    visible = project.layerTreeRoot().checkedLayers()
    below = next((layer for layer in layers_below(project, maps) if layer in visible), None)
    return {**{name: values.get(name) for name in DRAWN}, "TITLE": road_map.title,
            **({} if below is None else {"BELOW": below.id(), "CREDIT": credit_of(below)})}


# A window of QGIS with the runs since it was started: one table for each algorithm.

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


# The manual in a window of its own: the pages of docs/manual, read from the plugin's folder, in the user's language where they are translated.

PAGES = Path(__file__).resolve().parents[1] / "docs" / "manual"
SCHEME = "lanewright"  # lanewright:detectcurbs is what an algorithm's Help button opens


class ManualWindow(QMainWindow):
    def __init__(self, parent=None):
        super().__init__(parent, windowTitle=tr("Lanewright manual"))
        self.resize(980, 760)
        self.browser = PageBrowser(self)
        self.setCentralWidget(self.browser)
        bar = QToolBar(self)
        self.addToolBar(bar)
        bar.addAction(tr("Contents"), self.open)
        bar.addAction(tr("Back"), self.browser.backward)
        bar.addAction(tr("Forward"), self.browser.forward)
        QDesktopServices.setUrlHandler(SCHEME, self.open_address)

    @pyqtSlot()
    def open(self):
        self.show_page("index")

    @pyqtSlot(QUrl)
    def open_address(self, url):
        """What a lanewright: address names; the contents where there is no such page."""
        self.show_page(url.path().strip("/"))

    def show_page(self, name):
        self.browser.setSource(QUrl.fromLocalFile(str(page_path(name))), QTextDocument.ResourceType.MarkdownResource)
        self.show()
        self.raise_()

    def forget(self):
        QDesktopServices.unsetUrlHandler(SCHEME)
        self.close()


def page_path(name, language=""):
    """The file of a page in a language, by default that of QGIS; in English where it is not translated, the contents where there is no such page."""
    translated = PAGES / (language or chosen_language())[:2]
    pages = [folder / f"{page}.md" for page in (name, "index") for folder in (translated, PAGES)]
    return next(page for page in pages if page.is_file())


class PageBrowser(QTextBrowser):
    """Markdown pages with links among them; addresses elsewhere open in the web browser."""

    def __init__(self, parent):
        super().__init__(parent, openLinks=False, anchorClicked=self.follow)
        self.document().setDefaultStyleSheet("td, th { padding: 2px 8px; } ")

    def follow(self, url):
        if url.scheme() in ("http", "https"):
            QDesktopServices.openUrl(url)
            return
        target = self.source().resolved(url)
        if target.path().endswith(".md"):
            self.setSource(target, QTextDocument.ResourceType.MarkdownResource)
        else:
            self.scrollToAnchor(url.fragment())

    def loadResource(self, kind, url):
        """Pictures no wider than the window."""
        resource = super().loadResource(kind, url)
        if kind == QTextDocument.ResourceType.ImageResource:
            picture = QPixmap(self.source().resolved(url).toLocalFile())
            widest = max(self.viewport().width() - 40, 300)
            if picture.width() > widest:
                return picture.scaledToWidth(widest, Qt.TransformationMode.SmoothTransformation)
            return picture
        return resource
