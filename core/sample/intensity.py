"""How strong the pulses come back."""

import numpy as np

from .casting import OBSTACLE
from .scene import LABEL

# Share of near-infrared light sent back by each ground.
_BRIGHTNESS = {"road": 0.100, "worn paint": 0.125, "paint": 0.46, "manhole": 0.30, "gutter": 0.21, "curb face": 0.21,
               "curb stone": 0.22, "sidewalk": 0.17, "shoulder": 0.16, "verge": 0.30, "stray": 0.05}
_TABLE = np.zeros(len(LABEL))
for _name, _value in _BRIGHTNESS.items():
    _TABLE[LABEL[_name]] = _value
_FULL_SCALE = 64000.0  # counts from a white surface met head-on at no distance
_HALF_RANGE = 11.0     # m, where the strength has fallen to one half


def label_hits(scene, hits, found):
    """Label of the hits at indices `found`."""
    strip, label = hits.strip[found], hits.label[found]
    road = strip == 0
    label[road] = scene.carriageway_labels(hits.station[found[road]], hits.offset[found[road]])
    for side in (scene.left, scene.right):
        names = np.array([0] + [LABEL[name] for name in side.strips], dtype=np.uint8)
        beside = (strip * side.sign > 0) & (strip != OBSTACLE)
        label[beside] = names[np.abs(strip[beside])]
    return label


def brightness_of(scene, label, s, d, own):
    """Reflectance of hits: by ground, with the patchiness of asphalt, repairs and wheel tracks.

    `own` is the brightness of hits on obstacles.
    """
    texture = scene.texture
    bright = np.where(_TABLE[label] > 0, _TABLE[label], own)
    asphalt = np.flatnonzero((label == LABEL["road"]) | (label == LABEL["worn paint"]))
    at_s, at_d = s[asphalt], d[asphalt]
    patchy = 1.0 + 0.07 * texture.at(at_s, at_d, 1.7) + 0.08 * texture.at(at_s, at_d, 0.06)
    if len(at_s):
        near = (scene.repairs[:, 1] > at_s.min()) & (scene.repairs[:, 0] < at_s.max())
        for start, end, right, left, factor in scene.repairs[near]:
            patchy[(at_s >= start) & (at_s <= end) & (at_d >= right) & (at_d <= left)] *= factor
    bright[asphalt] *= np.maximum(patchy, 0.4)
    other = np.flatnonzero((label == LABEL["paint"]) | (label >= LABEL["gutter"]))
    bright[other] *= np.maximum(1.0 + 0.10 * texture.at(s[other], d[other], 0.05), 0.4)
    return bright


def received(brightness, distance, cosine, gain):
    """Strength in counts, without noise.

    A diffuse surface gives brightness * cosine (the power below 1, as
    rough asphalt does); the range law 1 / (1 + (R / R0)^2) is the inverse square
    far away and levels off near the scanner, where a receiver sees only part of
    the spot.
    """
    return _FULL_SCALE * gain * brightness * np.maximum(cosine, 0.0) ** 0.7 / (1.0 + (distance / _HALF_RANGE) ** 2)
