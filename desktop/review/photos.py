"""Photos along the road: point layers that name image files, and the photo that shows a place best."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    Qgis,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsFeatureRequest,
    QgsPointXY,
    QgsProject,
    QgsProviderRegistry,
    QgsRectangle,
    QgsUnitTypes,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize, Qt, QUrl
from qgis.PyQt.QtGui import QCursor, QDesktopServices, QIcon, QImageReader, QPixmap
from qgis.PyQt.QtWidgets import QPushButton

from ...processing_provider.texts import tr

SUFFIXES = (".jpg", ".jpeg", ".png", ".tif", ".tiff", ".webp")
NETWORK = ("//", "\\\\")   # what a layer names on another computer is not asked for
DIRECTIONS = ("direction", "heading", "yaw", "azimuth")   # names of fields, degrees clockwise from north; QGIS's own is the first
FARTHEST = 30.0   # m from a photo to what it shows: a curb farther off is a few pixels high
HALF_VIEW = 60.0  # degrees to either side of the direction
SHOWN = QSize(320, 180)   # pixels at most


@dataclass(frozen=True)
class Photo:
    """path : of the file; distance : m from where it was taken to the place; looks_at_it : as far as its direction is known."""

    path: Path
    distance: float
    looks_at_it: bool


def photo_of(project: QgsProject, place: QgsPointXY, crs: QgsCoordinateReferenceSystem) -> Photo | None:
    """The nearest photo that looks at a place, else the nearest, of the point layers that name files; None where no file is near."""
    vectors = [layer for layer in project.mapLayers().values() if isinstance(layer, QgsVectorLayer)]
    photos = [photo for layer in vectors if layer.geometryType() == Qgis.GeometryType.Point for photo in _photos_near(layer, project, place, crs)]
    return min(photos, key=lambda photo: (not photo.looks_at_it, photo.distance), default=None)


def _photos_near(layer, project, place, crs):
    unit = QgsUnitTypes.fromUnitToUnitFactor(crs.mapUnits(), Qgis.DistanceUnit.Meters)
    area = QgsRectangle.fromCenterAndSize(place, 2 * FARTHEST / unit, 2 * FARTHEST / unit)
    to_layer = QgsCoordinateTransform(crs, layer.crs(), project)
    to_place = QgsCoordinateTransform(layer.crs(), crs, project)
    folder = Path(QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source()).get("path") or "").parent
    names = [field.name() for field in layer.fields() if not field.isNumeric()]
    directions = [field.name() for field in layer.fields() if field.name().lower() in DIRECTIONS and field.isNumeric()]
    try:
        for feature in layer.getFeatures(QgsFeatureRequest().setFilterRect(to_layer.transformBoundingBox(area))):
            taken = to_place.transform(feature.geometry().centroid().asPoint())
            files = [folder / text for name in names if not (text := str(feature[name])).startswith(NETWORK)]
            path = next((path for path in files if path.suffix.lower() in SUFFIXES and path.is_file()), None)
            if path is not None:
                east, north = place.x() - taken.x(), place.y() - taken.y()
                turned = [(math.degrees(math.atan2(east, north)) - feature[name] + 180.0) % 360.0 - 180.0
                          for name in directions if isinstance(feature[name], (int, float))]
                yield Photo(path, math.hypot(east, north) * unit, not turned or abs(turned[0]) <= HALF_VIEW)
    except QgsCsException:
        return


class PhotoButton(QPushButton):
    """The photo of a place, small; a click opens it as the computer opens photos. Hidden where there is none."""

    def __init__(self):
        super().__init__(flat=True, cursor=QCursor(Qt.CursorShape.PointingHandCursor), visible=False, clicked=lambda checked=False:
                         QDesktopServices.openUrl(QUrl.fromLocalFile(str(self.photo.path))))
        self.photo: Photo | None = None

    def show_photo(self, photo: Photo | None) -> None:
        """Show a photo, read no larger than it is shown; None for none."""
        if photo is not None and photo != self.photo:
            reader = QImageReader(str(photo.path))
            reader.setAutoTransform(True)
            reader.setScaledSize(reader.size().scaled(SHOWN, Qt.AspectRatioMode.KeepAspectRatio))
            picture = QPixmap.fromImage(reader.read())
            self.setIcon(QIcon(picture))
            self.setIconSize(picture.size())
            self.setToolTip(tr("{name}, taken {distance:.0f} m from here. A click opens it.").format(name=photo.path.name, distance=photo.distance))
        self.photo = photo
        self.setVisible(photo is not None and not self.icon().isNull())
