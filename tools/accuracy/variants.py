"""The same street surveyed otherwise: mirrored, turned, driven the other way, thinned, with stations that begin elsewhere.

A variant changes points and trajectory; its road map is changed back and judged by the truth of the street itself. None should make
much of a difference: mirrored, a map of right-hand traffic becomes one of left-hand traffic. A mirrored survey has no CRS: with that of the street
it would lie where traffic drives on the other side.
"""

from dataclasses import dataclass

import laspy
import numpy as np
import shapely

ANGLE = 37.0     # degrees, counter-clockwise
LED_BACK = 0.5   # m of the drive at least whose direction and speed lead back from its beginning


@dataclass(frozen=True)
class Variant:
    """How a survey is changed.

    name : for the page
    mirrored : x becomes -x
    turned : degrees, counter-clockwise
    reversed : the same track driven the other way
    every : of so many points one is kept
    moved : m by which the drive, and so the stations, begin earlier
    """

    name: str
    mirrored: bool = False
    turned: float = 0.0
    reversed: bool = False
    every: int = 1
    moved: float = 0.0

    def _matrix(self):
        """(2, 2), by which rows of places about the centre are multiplied."""
        cos, sin = np.cos(np.radians(self.turned)), np.sin(np.radians(self.turned))
        return np.array([[-1.0 if self.mirrored else 1.0, 0.0], [0.0, 1.0]]) @ np.array([[cos, sin], [-sin, cos]])

    def places(self, places, centre):
        """(N, 2) m, where places lie in the variant; the (2,) centre stays where it is."""
        return (places - centre) @ self._matrix() + centre

    def back(self, geometry, centre):
        """A line or polygon of the variant's road map where it lies on the street itself, drawn in the direction driven there."""
        undo = np.linalg.inv(self._matrix())
        moved = shapely.transform(geometry, lambda xyz: np.column_stack([(xyz[:, :2] - centre) @ undo + centre, xyz[:, 2]]), include_z=True)
        return shapely.reverse(moved) if self.reversed else moved

    def trajectory(self, rows, centre):
        """(N, 7) time, x, y, z, roll, pitch, heading (degrees) of the variant."""
        rows = rows.copy()
        if self.moved:
            away = np.hypot(*(rows[:, 1:3] - rows[0, 1:3]).T)
            k = int(np.argmax(away > max(self.moved, LED_BACK)))
            before = rows[0] - (rows[k] - rows[0]) * self.moved / away[k]
            rows = np.vstack([np.r_[before[:4], rows[0, 4:]], rows])
        rows[:, 1:3] = self.places(rows[:, 1:3], centre)
        if self.mirrored:
            rows[:, 4] *= -1
            rows[:, 6] *= -1
        rows[:, 6] -= self.turned
        if self.reversed:
            rows[:, 0] = rows[0, 0] + rows[-1, 0] - rows[:, 0]
            rows[:, 4:6] *= -1
            rows[:, 6] += 180.0
            rows = rows[::-1]
        rows[:, 6] %= 360.0
        return rows

    def write_cloud(self, source, target, centre, span):
        """Write the points of the variant; `span` is the first and the last time of the trajectory."""
        las = laspy.read(source)
        las.points = las.points[np.arange(len(las.points))[::-self.every if self.reversed else self.every]]
        moved = self.places(np.column_stack([las.x, las.y]), centre)
        for k, axis in enumerate("xy"):
            setattr(las, axis, moved[:, k])
        if self.reversed:
            las.gps_time = span[0] + span[1] - np.asarray(las.gps_time)
        if self.mirrored:
            las.header.vlrs = [record for record in las.header.vlrs if record.user_id != "LASF_Projection"]
            if "scan_angle" in las.point_format.dimension_names:
                las.scan_angle = -np.asarray(las.scan_angle)
        las.write(str(target))


VARIANTS = (Variant("mirrored", mirrored=True), Variant(f"turned by {ANGLE:.0f}°", turned=ANGLE),
            Variant("driven the other way", reversed=True), Variant("thinned by half", every=2))
