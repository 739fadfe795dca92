"""A curb drawn in sections: a click near a step finds its face in the points, and the faces of neighbouring sections make one line."""

from __future__ import annotations

from functools import partial

import numpy as np
from qgis.core import QgsGeometry, QgsLineString

from ...core.common.errors import RoadExtractionError
from ...core.corrections.pick import Face, face_at
from ...core.corrections.weights import PICK
from ...processing_provider.texts import tr
from .corrections_layer import SAME_PLACE, add_correction, correction_at, layer_of, layer_to_write, take_back
from .smart_pick import in_metres, metres_of

NEXT = 20.0   # m from one section of a line to the next at most
ALONE = 1.0   # m of curb that one section stands for, as far as a step to the next


class CurbLine:
    """The curb that is drawn in the sections of a dock; each method returns what it has to say, `face` is what was found and not kept yet."""

    def __init__(self, dock):
        self.dock = dock
        self.face: Face | None = None
        self.lines: list[list[Face]] = []   # the faces along the line, after each click that added one

    def click(self, offset: float) -> str:
        """Find the face about a place of the section: the first of a line is shown, the same again or the next one is added."""
        section = self.dock.section
        x, y = np.array([section.x, section.y]) + offset * np.array(section.left)
        work = partial(face_at, x=x, y=y, azimuth=section.azimuth)
        before, self.face = self.face, in_metres(work, metres_of(self.dock.road_map), self.dock.points_about(x, y))
        if self.face is None:
            return tr("No step of {step:.0f} cm within {reach:.1f} m of the click; it takes a metre along the road, with ground on both sides.",
                      step=100 * PICK.section_step, reach=PICK.section_reach)
        if any(_apart(self.face, face) < SAME_PLACE for face in (self.lines or [[]])[-1]):
            self.face = None
            return tr("The line has this place already.")
        if before is not None and _apart(self.face, before) < SAME_PLACE or self._goes_on():
            return self.keep()
        return tr("{curb}. Enter or another click adds it, Esc drops it.", curb=_evidence([self.face]))

    def keep(self) -> str:
        """Add what was found to the corrections: to the line that it goes on with, else as a line of its own."""
        layer = None if self.face is None else layer_to_write(self.dock.iface, self.dock.road_map, self.dock.ask_for_file)
        if layer is None:
            return ""
        line = self.lines[-1] if self._goes_on() else []
        former = self._row_of(layer, line) if line else None   # None where it was taken back meanwhile
        if former is None:
            line, self.lines = [], []
        self.lines.append([self.face, *line] if line and _apart(self.face, line[0]) < _apart(self.face, line[-1]) else [*line, self.face])
        self.face = None
        return self._write(layer, former)

    def drop(self) -> str:
        """Forget what was found; where there is nothing such, the line is ready and the next click begins another."""
        if self.face is None:
            self.lines = []
        self.face = None
        return ""

    def undo(self) -> str:
        """Take back what was found, else what the last click added."""
        layer, line = layer_of(self.dock.road_map), [] if self.face is not None or not self.lines else self.lines.pop()
        self.face = None
        former = self._row_of(layer, line) if layer is not None and line else None
        if former is None:
            return ""
        if self.lines:
            return self._write(layer, former)
        take_back(layer, former)
        self.dock.corrected.emit()
        return tr("Taken back.")

    def _goes_on(self):
        """Whether what was found is the next of the line: in a section near one of its ends, and farther along the road than across."""
        line, section, most = self.lines[-1] if self.lines else [], self.dock.section, NEXT / metres_of(self.dock.road_map)
        steps = [(self.face.places[0] - face.places[0])[:2] for face in line[:1] + line[-1:]]
        return any(abs(step @ section.left) <= abs(step @ section.ahead) <= most for step in steps)

    def _row_of(self, layer, line):
        return correction_at(layer, self._geometry(line), self._crs, "edge")

    def _geometry(self, line):
        """The line through the bottoms of faces; through one alone it runs along the curb there."""
        places = np.array([face.places[0] for face in line])
        if len(line) == 1:
            angle, half = np.radians(line[0].direction), ALONE / 2 / metres_of(self.dock.road_map)
            places = places + half * np.array([[-1.0], [1.0]]) * (np.sin(angle), np.cos(angle), 0.0)
        return QgsGeometry(QgsLineString(*places.T.tolist()))

    @property
    def _crs(self):
        return self.dock.road_map.vectors[0].crs()

    def _write(self, layer, former):
        line = self.lines[-1]
        try:
            add_correction(layer, self._geometry(line), self._crs, former, action="draw", target="edge", note=_evidence(line),
                           height_m=round(float(np.median([face.height for face in line])), 3))
        except RoadExtractionError as problem:   # the disk is full, or the database is gone
            self.lines.pop()
            return str(problem)
        self.dock.corrected.emit()
        return tr("{curb}, added. A click in the next section goes on, Ctrl+Z takes it back, Esc ends it.", curb=_evidence(line))


def _apart(face, other):
    return float(np.hypot(*(face.places[0] - other.places[0])[:2]))


def _evidence(line):
    """What was seen, for the person and for the note of the correction."""
    height, sigma, across = 100 * np.median([(face.height, face.sigma_height, face.sigma_across) for face in line], axis=0)
    text = tr("Curb of {height:.1f} ± {sigma:.1f} cm, foot ± {across:.1f} cm", height=height, sigma=sigma, across=across)
    return text if len(line) == 1 else tr("{curb}, in {count} sections", curb=text, count=len(line))
