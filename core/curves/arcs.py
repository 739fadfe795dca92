"""Straight lines and circles through points."""

import numpy as np

from .curve import Arc
from .fit import Fit, checked, chord, minimise


def fit_line(x, y):
    """A straight line by orthogonal, robust least squares.

    Parameters
    ----------
    x, y : (N,) metres, N >= 2, ordered along the line

    Returns
    -------
    Fit with an Arc of curvature 0 from the first point's foot to the last's.
    """
    x, y = checked(x, y, 2)
    return _fit(x, y, bend=0.0, free_bend=False)


def fit_circle(x, y):
    """A circle: Taubin's algebraic fit as start, then the geometric distance, robustly.

    The unknowns are heading, offset and curvature at the points' middle, so that a
    nearly straight line is as easy as a tight bend. Kasa's simpler fit is not used:
    it is biased to small radii on short arcs.

    Parameters
    ----------
    x, y : (N,) metres, N >= 3, ordered along the line

    Returns
    -------
    Fit with an Arc from the first point's foot to the last's.

    References
    ----------
    Taubin (1991), IEEE PAMI 13, 1115-1138; Chernov (2010), Circular and linear regression, ch. 5-7.
    """
    x, y = checked(x, y, 3)
    return _fit(x, y, taubin_curvature(x, y), free_bend=True)


def taubin_curvature(x, y):
    """Signed curvature (1/m, left positive in the order of the points) of Taubin's circle; 0 for points in a line."""
    x, y = checked(x, y, 3)
    dx, dy = x - x.mean(), y - y.mean()
    size = np.sqrt(np.mean(dx**2 + dy**2))
    if size == 0:
        return 0.0
    dx, dy = dx / size, dy / size
    q = dx**2 + dy**2
    # Taubin's constraint, reduced to a 3 x 3 singular value problem (Chernov's TaubinSVD)
    design = np.c_[(q - 1.0) / 2.0, dx, dy]
    a, b, c = np.linalg.svd(design, full_matrices=False)[2][-1]
    a, d = a / 2.0, -a / 2.0
    root = b * b + c * c - 4 * a * d
    if root <= 0:
        return 0.0
    bend = 2 * abs(a) / np.sqrt(root) / size
    if bend < 1e-9:
        return 0.0
    centre = np.array([-b, -c]) / (2 * a)
    direction = chord(x, y)[1]
    return float(bend * np.sign(centre[1] * np.cos(direction) - centre[0] * np.sin(direction)))


def _fit(x, y, bend, free_bend):
    middle, direction = chord(x, y)
    dx, dy = x - middle[0], y - middle[1]
    size = max(float(np.sqrt(np.mean(dx**2 + dy**2))), 1e-3)

    def parts(unknown):
        offset, turn = unknown[:2]
        k = unknown[2] if free_bend else 0.0
        c, s = np.cos(direction + turn), np.sin(direction + turn)
        along, across = dx * c + dy * s, dy * c - dx * s - offset
        lift = 2 * across - k * (along**2 + across**2)
        root = np.sqrt(np.maximum(1 - k * lift, 1e-12))
        return along, across, k, root, lift / (1 + root)

    def residuals(unknown):
        return parts(unknown)[4]

    def jacobian(unknown):
        along, across, k, root, e = parts(unknown)
        # how the distance changes with `across`, `along` and k, from lift = 2 across - k (along^2 + across^2)
        by_across, by_along = (1 - k * across) / root, -k * along / root
        columns = [-by_across, by_across * -along + by_along * (across + unknown[0])]
        if free_bend:
            columns.append((e**2 - along**2 - across**2) / (2 * root))
        return np.stack(columns, 1)

    sagitta = np.average(dx * -np.sin(direction) + dy * np.cos(direction))
    start = [sagitta - bend * size**2 / 2, 0.0] + ([bend] if free_bend else [])
    scale = [1.0, 1.0 / size, 1.0 / size**2][:len(start)]
    unknown = minimise(residuals, jacobian, np.array(start), scale)
    along, across, k, root, e = parts(unknown)
    turned = direction + unknown[1]
    arc = Arc(float(middle[0] - unknown[0] * np.sin(turned)), float(middle[1] + unknown[0] * np.cos(turned)),
              float(turned), float(k), 0.0)
    u, e = arc.foot(x, y)
    first, last = float(u[0]), float(u[-1])
    (x0, y0), = arc.at(np.array([first]))
    curve = Arc(float(x0), float(y0), float(arc.heading(first)), float(k), last - first)
    return Fit(curve, curve.foot(x, y)[1], 3 if free_bend else 2)
