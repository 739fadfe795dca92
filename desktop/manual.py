"""The manual in a window of its own: the pages of docs/manual, read from the plugin's folder, in the user's language where they are translated."""

from pathlib import Path

from qgis.PyQt.QtCore import Qt, QUrl, pyqtSlot
from qgis.PyQt.QtGui import QDesktopServices, QPixmap, QTextDocument
from qgis.PyQt.QtWidgets import QMainWindow, QTextBrowser, QToolBar

from ..processing_provider.texts import chosen_language, tr

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
