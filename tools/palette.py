"""Pictures of windows with 256 colours: a manual travels in the plugin's zip, and a map in full colour takes three times the room."""

import cv2
import numpy as np
from qgis.PyQt.QtGui import QImage, qRgb
from scipy.spatial import cKDTree

COLOURS = 256
FREQUENT = 96        # colours kept as they are: paper, text, symbols
SAMPLE = 40_000      # of the other colours, from which the palette is made
SEED = 1             # the same window gives the same picture


def with_palette(image: QImage) -> QImage:
    """The picture with a palette of its own: its most frequent colours, and the middles of clusters of all others."""
    colours, which, counts = _colours(image)
    if len(colours) <= COLOURS:
        palette, nearest = colours, np.arange(len(colours))
    else:
        palette = _palette(colours, counts)
        nearest = _nearest(colours, palette)
    height, width = image.height(), image.width()
    rows = np.zeros((height, (width + 3) // 4 * 4), np.uint8)  # Qt's rows are whole words
    rows[:, :width] = nearest[which].reshape(height, width)
    picture = QImage(rows.tobytes(), width, height, rows.shape[1], QImage.Format.Format_Indexed8).copy()
    picture.setColorTable([qRgb(*(int(value) for value in colour)) for colour in palette])
    return picture


def _colours(image):
    """(K, 3) different colours, (N,) which of them each pixel has, (K,) how many pixels have it."""
    plain = image.convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(plain.constBits().asstring(plain.sizeInBytes()), np.uint8).reshape(plain.height(), plain.bytesPerLine())
    red, green, blue = rows[:, :3 * plain.width()].reshape(-1, 3).astype(np.uint32).T
    codes, which, counts = np.unique(red << 16 | green << 8 | blue, return_inverse=True, return_counts=True)
    return np.c_[codes >> 16, codes >> 8 & 255, codes & 255].astype(np.uint8), which, counts


def _palette(colours, counts):
    order = np.argsort(-counts, kind="stable")
    kept, others = order[:FREQUENT], order[FREQUENT:]
    random = np.random.default_rng(SEED)
    # a colour that few pixels have may be all of a thin line: by the root, not by the number
    weight = np.sqrt(counts[others])
    sample = random.choice(others, SAMPLE, p=weight / weight.sum())
    cv2.setRNGSeed(SEED)
    _, _, middles = cv2.kmeans(colours[sample].astype(np.float32), min(COLOURS - FREQUENT, len(others)), None,
                               (cv2.TERM_CRITERIA_MAX_ITER, 12, 0), 1, cv2.KMEANS_PP_CENTERS)
    return np.r_[colours[kept], np.rint(middles).astype(np.uint8)]


def _nearest(colours, palette):
    """Row of the palette that is nearest to each colour."""
    return cKDTree(palette.astype(float)).query(colours.astype(float))[1]
