"""Where laser pulses meet the made street: the ground by its strips, obstacles by their shapes.

Ground. A pulse is followed to the carriageway continued beyond its edges
(three Newton steps). If it arrives beyond an edge, the borders of the strips
there (curb bottom, curb top, ...) are passed one after the other; the first
strip whose outer border the pulse reaches from below holds the hit, which
the secant rule then finds. So curb faces are hit where they are, and a
raised sidewalk hides what lies behind it.
"""

from dataclasses import dataclass

import numpy as np

from .street import LABEL
from .vehicle import attitude

# How strong the pulses come back.

# Share of near-infrared light sent back by each ground.
_REFLECTANCE = {"road": 0.100, "worn paint": 0.125, "paint": 0.46, "manhole": 0.30, "gutter": 0.21, "curb face": 0.21,
               "curb stone": 0.22, "sidewalk": 0.17, "shoulder": 0.16, "verge": 0.30, "stray": 0.05}
_REFLECTANCE_OF_LABEL = np.zeros(len(LABEL))
for _name, _value in _REFLECTANCE.items():
    _REFLECTANCE_OF_LABEL[LABEL[_name]] = _value
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
    bright = np.where(_REFLECTANCE_OF_LABEL[label] > 0, _REFLECTANCE_OF_LABEL[label], own)
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

OBSTACLE = 99      # the `strip` of a hit on an obstacle
_LONGEST = 70.0    # m, no pulse is followed further
_GRAZING = 0.02    # sine of the flattest way down that is followed
_MARGIN = 1.0      # m around the surveyed stretch within which the ground is computed


@dataclass
class Hits:
    """What each pulse met; arrays of one length, `distance` inf where it met nothing.

    `strip` is 0 for the carriageway, +k or -k for the k-th strip beyond the left
    or right edge, OBSTACLE for what stands on the ground (see `label`).
    """

    distance: np.ndarray
    station: np.ndarray
    offset: np.ndarray
    cosine: np.ndarray   # of the incidence angle
    strip: np.ndarray
    label: np.ndarray    # of obstacles; 0 where the ground was hit
    brightness: np.ndarray


def cast(scene, origin, direction, station, rng, reach):
    """Send pulses into the scene; the nearest hit wins.

    Parameters
    ----------
    origin, direction : (3, N) local coordinates, m; unit vectors
    station : float, rough station of the scanner, true within 15 m
    rng : decides among a tree's leaves and in a car's glass only
    reach : float, ground further than this from the axis is left out, m

    Returns
    -------
    Hits with N entries
    """
    hits = cast_ground(scene, origin, direction, station, reach)
    flat = np.hypot(direction[0], direction[1])
    here_x, here_y = origin[0].mean(), origin[1].mean()
    highest = origin[2].max()
    for obstacle in scene.obstacles:
        if np.hypot(obstacle.x - here_x, obstacle.y - here_y) > 1.6 * reach:
            continue
        to_x, to_y = obstacle.x - origin[0], obstacle.y - origin[1]
        aside = np.abs(to_x * direction[1] - to_y * direction[0])
        ahead = to_x * direction[0] + to_y * direction[1]
        toward = (aside <= obstacle.reach * flat) & (ahead > 0)
        if obstacle.label == LABEL["car"] and highest > obstacle.z + obstacle.top:
            toward &= direction[2] < 0
        near = np.flatnonzero(toward)
        if len(near) == 0:
            continue
        distance, cosine, brightness = obstacle.hits(origin[:, near], direction[:, near], rng)
        first = distance < np.minimum(hits.distance[near], _LONGEST)
        near = near[first]
        hits.distance[near], hits.cosine[near] = distance[first], cosine[first]
        hits.brightness[near], hits.label[near] = brightness[first], obstacle.label
        hits.strip[near] = OBSTACLE
    return hits


def cast_ground(scene, origin, direction, station, reach):
    """The same for the bare ground."""
    count = direction.shape[1]
    hits = Hits(np.full(count, np.inf), np.full(count, station), np.zeros(count), np.zeros(count),
                np.zeros(count, dtype=np.int8), np.zeros(count, dtype=np.uint8), np.zeros(count))
    down = np.flatnonzero(direction[2] < -_GRAZING)
    rays = _Rays(scene.axis, origin[:, down], direction[:, down])
    t = (rays.oz - scene.grade_line(station)) / -rays.vz
    s, d = rays.at(t, np.full(len(t), station), steps=2)
    # Only pulses that come down on the surveyed stretch are followed further.
    there = (t < _LONGEST) & (s > -4.0) & (s < scene.length + 4.0)
    there &= np.abs(d) < reach + 25.0
    rays, down, t, s, d = rays.some(there), down[there], t[there], s[there], d[there]
    for _ in range(3):
        # Newton's step, the road's slope along the ray from its grade and fall.
        error = rays.oz + t * rays.vz - scene.carriageway(s, d)
        ahead = rays.vx * rays.cos + rays.vy * rays.sin
        aside = rays.vy * rays.cos - rays.vx * rays.sin
        t = t - error / (rays.vz - scene.grade(s) * ahead - scene.cross_slope(d) * aside)
        s, d = rays.at(t, s, steps=1)
    strip = np.zeros(len(t), dtype=np.int8)
    for side in (scene.left, scene.right):
        beyond = np.flatnonzero(side.sign * d > side.edge)
        t[beyond], s[beyond], d[beyond], strip[beyond] = _beyond_edge(
            scene, side, rays.some(beyond), t[beyond], s[beyond], d[beyond])
    good = np.flatnonzero((t < _LONGEST) & (np.abs(d) <= reach) & (s > -_MARGIN) & (s < scene.length + _MARGIN))
    down, strip = down[good], strip[good]
    hits.distance[down], hits.station[down], hits.offset[down] = t[good], s[good], d[good]
    hits.strip[down] = strip
    hits.cosine[down] = _incidence(scene, rays.some(good), s[good], d[good], strip)
    return hits


def _beyond_edge(scene, side, rays, t, s, d):
    """Hits on the strips of one side, for pulses that pass its edge above the ground.

    Returns t, s, d and the signed number of the strip; t is inf where the pulse
    leaves over the last border.
    """
    found_t, found_s, found_d = np.full(len(t), np.inf), s.copy(), d.copy()
    found_strip = np.zeros(len(t), dtype=np.int8)
    outward = side.sign * (rays.vy * rays.cos - rays.vx * rays.sin)
    live = np.flatnonzero(outward > 0.02)
    t, s, away, ray = t[live], s[live], side.sign * d[live], rays.some(live)
    t, s, away = ray.reach(side, side.edge, t, s, away, times=3)
    on = np.flatnonzero((t > 0) & (np.abs(away - side.edge) < 0.01))
    live, ray, t, s, away = live[on], ray.some(on), t[on], s[on], away[on]
    above = ray.oz + t * ray.vz - scene.edge_height(side, s)
    for k in range(1, len(side.borders)):
        next_t, next_s, next_away = ray.reach(side, side.borders[k], t, s, away, times=2 if k < 3 else 3)
        # In a bend a few pulses run along a border and never pass it; they are left out.
        passed = (next_t >= t) & (np.abs(next_away - side.borders[k]) < 0.01)
        ground = scene.edge_height(side, next_s) + side.border_rise(k, next_s)
        next_above = ray.oz + next_t * ray.vz - ground
        met = np.flatnonzero(passed & (next_above <= 0))
        if len(met):
            at = live[met]
            found_t[at], found_s[at], found_d[at] = _within_strip(
                scene, side, k - 1, ray.some(met), (t[met], above[met]), (next_t[met], next_above[met]), s[met])
            found_strip[at] = side.sign * k
        on = np.flatnonzero(passed & (next_above > 0))
        live, ray = live[on], ray.some(on)
        t, s, away, above = next_t[on], next_s[on], next_away[on], next_above[on]
        if len(live) == 0:
            break
    return found_t, found_s, found_d, found_strip


def _within_strip(scene, side, strip, rays, near, far, s):
    """Where pulses meet one strip, between a place above and a place below it.

    Secant steps kept inside the bracket: the strip is plane but for the road's
    bend and a curb being lowered, so four of them leave less than 0.1 mm.
    """
    (low, f0), (high, f1) = near, far
    t0, t = high, low + (high - low) * f0 / np.where(f0 > f1, f0 - f1, 1.0)
    error0, steps = f1, 2
    for _ in range(4):
        s, d = rays.at(t, s, steps)
        ground = scene.edge_height(side, s) + side.rise_in_strip(strip, s, side.sign * d)
        error = rays.oz + t * rays.vz - ground
        change = error - error0
        usable = np.abs(change) > 1e-13
        step = np.where(usable, error * (t - t0) / np.where(usable, change, 1.0), 0.0)
        t0, error0, steps = t, error, 1
        t = np.clip(t - step, low, high)
    s, d = rays.at(t, s, 1)
    return t, s, d


def _incidence(scene, rays, s, d, strip):
    """Cosine between the pulse and the normal of the ground it meets."""
    slope = scene.cross_slope(d)
    for side in (scene.left, scene.right):
        beyond = np.flatnonzero(strip * side.sign > 0)
        slope[beyond] = side.sign * side.steepness(np.abs(strip[beyond]) - 1, s[beyond])
    grade = scene.grade(s)
    ahead = rays.vx * rays.cos + rays.vy * rays.sin
    aside = rays.vy * rays.cos - rays.vx * rays.sin
    return (grade * ahead + slope * aside - rays.vz) / np.sqrt(1.0 + slope * slope + grade * grade)


class _Rays:
    """Pulses with the direction of the road below where they were last followed to."""

    def __init__(self, axis, origin, direction, cos=None, sin=None):
        self.axis, self.cos, self.sin = axis, cos, sin
        self.ox, self.oy, self.oz = origin
        self.vx, self.vy, self.vz = direction

    def some(self, which):
        if isinstance(which, np.ndarray) and which.dtype == bool:
            which = np.flatnonzero(which)
        return _Rays(self.axis, (self.ox[which], self.oy[which], self.oz[which]),
                     (self.vx[which], self.vy[which], self.vz[which]), self.cos[which], self.sin[which])

    def at(self, t, s, steps):
        """Station and offset after a way t, from stations nearby."""
        s, d, self.cos, self.sin = self.axis.locate(self.ox + t * self.vx, self.oy + t * self.vy, s, steps)
        return s, d

    def reach(self, side, distance, t, s, away, times):
        """Way, station and distance from the axis where pulses pass a border, from a place before or after it."""
        for _ in range(times):
            outward = side.sign * (self.vy * self.cos - self.vx * self.sin)
            t = t + (distance - away) / np.maximum(outward, 0.01)
            s, d = self.at(t, s, steps=2 if times > 2 else 1)
            away = side.sign * d
        return t, s, away


# Two rotating line scanners on the roof, their planes crossed like the wings of a butterfly.

_HIGHEST = np.sin(np.radians(50.0))  # pulses steeper upwards meet nothing on this street


@dataclass(frozen=True)
class Scanner:
    """A line scanner: one pulse after the other around its axis.

    Attributes
    ----------
    number : point_source_id
    rotation_rate : turns per second
    pulse_rate : pulses per second
    yaw : degrees, the axis turned from straight ahead, counter-clockwise
    tilt : degrees, negative leans the lower half of the scan plane backwards
    lever_arm : m ahead, left and up of the trajectory's point
    gain : its sensitivity beside the other's
    """

    number: int
    rotation_rate: float
    pulse_rate: float
    yaw: float
    tilt: float
    lever_arm: tuple
    gain: float

    def line(self):
        """Share of the turn and direction in the vehicle's frame, (N,) and (3, N), of the pulses of one line."""
        count = int(round(self.pulse_rate / self.rotation_rate))
        share = np.arange(count) / count
        angle = 2 * np.pi * share
        yaw, tilt = np.radians(self.yaw), np.radians(self.tilt)
        plane = np.stack([np.zeros(count), np.sin(angle), -np.cos(angle)])
        lean = np.array([[np.cos(tilt), 0, -np.sin(tilt)], [0, 1, 0], [np.sin(tilt), 0, np.cos(tilt)]])
        turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
        directions = turn @ lean @ plane
        used = directions[2] < _HIGHEST
        return share[used], directions[:, used]

    def pulses(self, drive, lines):
        """Origins, directions ((3, N), local), times since the start and scan angles of some turns."""
        share, along = self.line()
        x, y, z, roll, pitch, heading = drive.pose(np.append(lines, lines[-1] + 1) / self.rotation_rate)
        turn = attitude(roll, pitch, heading)
        place = np.stack([x, y, z], axis=1) + turn @ np.array(self.lever_arm)
        # Within one turn (5 ms) the vehicle moves straight and turns evenly, to a few micrometres.
        change, moved = np.diff(turn, axis=0), np.diff(place, axis=0)
        direction = np.einsum("lij,jn->iln", turn[:-1], along) + np.einsum("lij,jn->iln", change, along * share)
        origin = place[:-1].T[:, :, None] + moved.T[:, :, None] * share
        times = (lines[:, None] + share) / self.rotation_rate
        angle = np.where(share < 0.5, share, share - 1.0) * 360.0
        return origin.reshape(3, -1), direction.reshape(3, -1), times.ravel(), np.tile(angle, len(lines))


def butterfly(rotation_rate, pulse_rate, yaw):
    """Left and right scanner behind and above the trajectory's point, as on a roof-mounted two-scanner system.

    yaw : degrees by which their planes are turned from straight across, one either way
    """
    return [Scanner(1, rotation_rate, pulse_rate, -yaw, -20.0, (-2.45, 0.32, 0.0), 1.0),
            Scanner(2, rotation_rate, pulse_rate, yaw, -20.0, (-2.45, -0.32, 0.0), 0.94)]
