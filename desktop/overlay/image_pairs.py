"""One image of the window of control points: its layer of pairs, what the accepted ones say, and their pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from qgis.core import NULL, QgsProject, QgsVectorLayer
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QImage, QPainter, QPen, QPixmap

from ...core.io.geotiff import IntensityImage
from ...processing_provider.texts import tr
from ...products.overlay.control_points import REQUIRED_COLUMNS
from ...products.overlay.matching.placement import highest_order, left_out_residuals
from ...products.overlay.matching.propose import AMBIGUOUS, AWAY, REPEATS, WEAK
from ...products.overlay.pair_cutouts import pair_cutouts
from ...products.overlay.source_image import open_image

SIDE = 116       # px, of a cut-out
GAP = 4          # px, between the two of a pair
CROSS = 7        # px, half the cross in the middle
ORDER = 2        # of the polynomial, where the pairs are enough for it
GREEN, RED = "#33a02c", "#e6323c"


class ImagePairs:
    """An image and its pairs.

    path : of the image
    failed : why no pairs were found, "" where none were looked for or some were found
    rough : layer of two points that say roughly where it lies, None where none were given
    placed : what became of placing it on the map, "" before
    """

    def __init__(self, path: str):
        self.path = path
        self.failed = self.placed = ""
        self.rough: QgsVectorLayer | None = None
        self._layer = ""

    @property
    def name(self) -> str:
        return Path(self.path).name

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer of pairs; None where there is none, or it was taken out of the project."""
        return QgsProject.instance().mapLayer(self._layer)

    def found(self, layer: QgsVectorLayer) -> None:
        """Take the layer that "Propose control points" made."""
        self._layer, self.failed, self.placed = layer.id(), "", ""
        layer.setName(tr("Control points of {image}").format(image=Path(self.path).stem))

    def lies_about(self, rough: QgsVectorLayer) -> None:
        """Take two rough points; pairs found before are forgotten."""
        self.rough, self._layer, self.failed = rough, "", ""

    def failed_because(self, reason: str) -> None:
        self._layer, self.failed = "", reason

    def rows(self) -> list:
        """The features of the layer, in order of their names."""
        layer = self.layer
        return [] if layer is None else sorted(layer.getFeatures(), key=lambda row: int(row["point"]))

    def accept(self, ids: list[int], accepted: bool) -> None:
        """Accept or refuse the pairs of some features."""
        layer = self.layer
        if layer is None:
            return
        column = layer.fields().lookupField("accepted")
        layer.dataProvider().changeAttributeValues({number: {column: int(accepted)} for number in ids})
        self._write_residuals(layer)
        layer.triggerRepaint()

    def _write_residuals(self, layer):
        """How far off the accepted pairs place each one, anew."""
        rows = self.rows()
        places = {name: np.array([float(value) for value in values]) for name, values in zip(REQUIRED_COLUMNS, zip(*(
            (row["pixel"], row["line"], row.geometry().constGet().x(), row.geometry().constGet().y()) for row in rows)))}
        used = np.array([bool(row["accepted"]) for row in rows])
        x, y = places["easting"] - places["easting"].mean(), places["northing"] - places["northing"].mean()
        order = highest_order(x[used], y[used], ORDER) if used.any() else 0
        residual = left_out_residuals(x, y, places["pixel"], places["line"], used, order) if order else np.full(len(rows), np.nan)
        column = layer.fields().lookupField("residual")
        layer.dataProvider().changeAttributeValues(
            {row.id(): {column: float(value) if value == value else NULL} for row, value in zip(rows, residual)})

    @property
    def order(self) -> int:
        """Of the polynomial that the accepted pairs determine; 0: none."""
        places = np.array([(row.geometry().constGet().x(), row.geometry().constGet().y()) for row in self.rows() if row["accepted"]])
        return highest_order(*places.T, ORDER) if len(places) else 0

    def summary(self) -> str:
        """What is known of the image, for the list of images."""
        if self.failed:
            return self.failed
        rows = self.rows()
        if not rows:
            return tr("not looked for yet") if self.rough is None else tr("two points given, not looked for yet")
        residuals = [row["residual"] for row in rows if row["accepted"] and row["residual"] not in (None, NULL)]
        summary = tr("{accepted} of {count} pairs accepted").format(accepted=sum(bool(row["accepted"]) for row in rows), count=len(rows))
        if residuals:
            summary += tr(", RMSE {rmse:.1f} cm, each left out in turn").format(rmse=100.0 * float(np.sqrt(np.mean(np.square(residuals)))))
        return f"{summary}\n{self.placed}" if self.placed else summary

    def pictures(self, intensity_path: str) -> list[QPixmap]:
        """Both cut-outs of each pair side by side, in the order of the rows."""
        rows = self.rows()
        if len(rows) < 2:
            return []
        columns = np.array([(row["pixel"], row["line"], row.geometry().constGet().x(), row.geometry().constGet().y()) for row in rows]).T
        return [_side_by_side(*pair) for pair in pair_cutouts(open_image(self.path), IntensityImage.open(intensity_path), *columns, side=SIDE)]


def pair_text(row) -> str:
    """Number, likeness and residual of a pair."""
    residual = row["residual"]
    distance = tr("{residual:.1f} cm off").format(residual=100.0 * residual) if residual not in (None, NULL) else "–"
    why = "" if row["accepted"] or row["why"] in (None, NULL, "") else f"\n{_words(row['why'])}"
    return tr("{number}: likeness {score:.2f}, {away}").format(number=row["point"], score=row["score"], away=distance) + why


def _words(why):
    """Why a pair is not accepted by default, in the user's language."""
    return {WEAK: tr("looks different"), REPEATS: tr("repeats nearby"), AWAY: tr("does not fit the others"),
            AMBIGUOUS: tr("all of it fits elsewhere too")}.get(why, why)


def _side_by_side(*cuts):
    canvas = QPixmap(2 * SIDE + GAP, SIDE)
    canvas.fill(Qt.GlobalColor.white)
    painter = QPainter(canvas)
    for number, cut in enumerate(cuts):
        left = number * (SIDE + GAP)
        data = np.ascontiguousarray(cut)
        painter.drawImage(left, 0, QImage(data.data, SIDE, SIDE, 3 * SIDE, QImage.Format.Format_RGB888).copy())
        painter.setPen(QPen(Qt.GlobalColor.yellow, 1))
        middle = left + SIDE // 2
        painter.drawLine(middle - CROSS, SIDE // 2, middle + CROSS, SIDE // 2)
        painter.drawLine(middle, SIDE // 2 - CROSS, middle, SIDE // 2 + CROSS)
    painter.end()
    return canvas
