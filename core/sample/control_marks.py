"""The ground control points of the made UAV image: corners of paint, and plates laid out beside the road."""

import numpy as np

from ..features import Features
from ..schemas import CONTROL_POINTS
from .camera import GROUND_PIXEL
from .obstacles import Crown

PLATE = 0.6            # m, side of a plate
_PLATE_EVERY = 40.0    # m along each rim of the image
_CORNERS = 18          # corners of paint
_CLEAR = 0.4           # m between a corner and what stands on the street
_SURVEYED = 0.008      # m, noise of the measured map coordinates
_POINTED = 0.25        # px, noise of pointing in the image
_EVERY_CHECK = 3       # each third corner of paint judges only; plates, which hold the rims, never


def plates(scene, camera):
    """[(x, y, turn)] of the plates, local coordinates: along both rims of the image, off the carriageway."""
    count = max(3, int(round(camera.width * GROUND_PIXEL / _PLATE_EVERY)) + 1)
    found = []
    for share in np.linspace(0.025, 0.975, count):
        for inward in (1, -1):
            # From the rim inwards, until nothing stands there
            down = 0.05 + 0.04 * np.arange(8)
            x, y = camera.to_map(np.full(8, share * camera.width), (down if inward > 0 else 1.0 - down) * camera.height)
            s, d = camera.to_road(scene, x, y)
            free = np.flatnonzero(_is_free(scene, x, y, PLATE) & ((d > scene.left.edge + PLATE) | (d < -scene.right.edge - PLATE)))
            if len(free):
                k = free[0]
                found.append((float(x[k]), float(y[k]), float(scene.axis.heading(s[k:k + 1])[0])))
    return found


def _is_free(scene, x, y, around):
    """Which local places are not under a car, a tree or a pole."""
    free = np.ones(len(x), dtype=bool)
    for obstacle in scene.obstacles:
        reach = obstacle.reach if isinstance(obstacle, Crown) else min(obstacle.reach, 2.4)
        free &= np.hypot(x - obstacle.x, y - obstacle.y) > reach + around
    return free


def _paint_corners(scene, camera):
    """(kinds, x, y) of the corners of paint within the image, thinned to those that lie apart."""
    kinds, s, d = [], [], []
    for marking in scene.paint.markings:
        for outline in marking.outlines():
            inside = (outline[:, 0] >= camera.stations[0]) & (outline[:, 0] <= camera.stations[1])
            kinds += [marking.kind] * int(inside.sum())
            s.append(outline[inside, 0])
            d.append(outline[inside, 1])
    if not kinds:
        return [], np.empty(0), np.empty(0)
    x, y = scene.axis.to_map(np.concatenate(s), np.concatenate(d))
    free = np.flatnonzero(_is_free(scene, x, y, _CLEAR))
    kept = free[_apart(x[free], y[free], _CORNERS)] if len(free) else free
    return [kinds[k] for k in kept], x[kept], y[kept]


def _apart(x, y, count):
    """Indices of places chosen one after the other, each the farthest from those before it."""
    chosen = [0]
    distance = np.hypot(x - x[0], y - y[0])
    while len(chosen) < min(count, len(x)) and distance.max() > 1.0:
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.hypot(x - x[chosen[-1]], y - y[chosen[-1]]))
    return np.array(chosen)


def uav_control_points(survey):
    """The points as a surveyor hands them over: Features in map coordinates with pixel and line.

    Map coordinates are measured to 8 mm, places in the image to a quarter of a pixel; every third corner of paint is a check.
    """
    from shapely import Point

    scene, camera, origin = survey.scene, survey.camera, np.array(survey.settings.origin)
    kinds, x, y = _paint_corners(scene, camera)
    laid = plates(scene, camera)
    kinds = kinds + ["plate"] * len(laid)
    x, y = np.append(x, [plate[0] for plate in laid]), np.append(y, [plate[1] for plate in laid])
    pixel, line = camera.to_pixel(x, y)
    s, d = camera.to_road(scene, x, y)
    z = scene.height(s, d)
    order = np.argsort(s, kind="stable")
    random = np.random.default_rng([survey.settings.seed, 4])
    surveyed, pointed = _SURVEYED * random.standard_normal((2, len(x))), _POINTED * random.standard_normal((2, len(x)))
    layer = Features("PointZ", CONTROL_POINTS, crs=survey.crs)
    judges = set(order[[k < len(x) - len(laid) for k in order]][::_EVERY_CHECK].tolist())
    for number, k in enumerate(order, 1):
        place = np.array([x[k] + surveyed[0, k], y[k] + surveyed[1, k], z[k]]) + origin
        layer.add(Point(place), point=str(number), role="check" if k in judges else "control",
                  pixel=float(pixel[k] + pointed[0, k]), line=float(line[k] + pointed[1, k]), kind=kinds[k])
    return layer

