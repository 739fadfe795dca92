"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

import numpy as np

from ..common.setting import table


@table
class FITS:
    """Curves through points: when a fit has converged, and what is worth a more complex curve."""

    arc_length_step: float = 0.25   # m between the nodes of the arc length table of curves without a formula for it
    max_projection_steps: int = 8   # Newton steps of a projection
    projection_tolerance: float = 1e-9   # m; a shorter step ends the projection
    end_tolerance: float = 1e-6   # m; farther beyond an end, a tabulated curve is straight
    noise_floor: float = 0.004   # m; a residual below it does not justify a more complex curve
    bandwidths: tuple[float, ...] = (1.0, 1.4, 2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0, 40.0, 60.0)   # m; six of them: the shortest wave that stays
    spline_points_per_batch: int = 4096   # points of a line times bandwidths; fits the processor's cache
    max_reweightings: int = 8   # of a spline in the plane,
    max_profile_reweightings: int = 6   # and of a profile
    weight_tolerance: float = 1e-6   # a smaller change of the weights moves the curve by less than a micrometre
    medium_rule_turn: float = 0.8   # radians from which on the second and the third rule serve
    fine_rule_turn: float = 3.0   # radians from which on the second and the third rule serve
    max_newton_steps: int = 10   # to the foot of a point on a curve: each squares the error, so that three to five do
    newton_tolerance: float = 1e-5   # m; after so short a step the error is about 1e-10 m
    max_start_bins: int = 12   # of the points of a line, from whose medians the start is made
    max_residual_p95: float = 0.05   # m; a simpler curve is selected only if 95 % of the points are nearer
    bic_margin: float = 6.0   # a simpler curve is selected if its BIC is within this of the best
    soft_l1_scale: float = 0.03   # m; the weight of larger residuals falls off (soft L1)
    coarse_points: int = 128   # points of a line to which it is fitted first
    fit_tolerance: float = 1e-12   # of the unknowns, or of the squares of the distances: a smaller gain of a step ends a fit,
    coarse_fit_tolerance: float = 1e-4   # and one that only begins another
    max_misfit_share: float = 0.05   # share of the points beyond `max_misfit` above which a fit is not refined
    robust_rounds: int = 5   # of reweighting the smoothed values, after which outliers have no weight any more
    outlier_factor: float = 3.0   # of the median deviation, at which a value has half its weight
    element_node_spacing: float = 4.0   # m between the nodes at which elements may join
    min_element_length: float = 8.0   # m
    max_element_length: float = 1000.0   # m; longer elements are found in parts
    min_element_sigma: float = 0.008   # m; no line is known better, when evidence is counted
    # Each element costs its free parameters and its end. The factor accounts for correlated errors of neighbouring points (worn paint,
    # trajectory drift), which plain BIC mistakes for shape.
    element_cost_factor: float = 2.0
    cost_margin: float = 1.0   # of cost, beyond all rounding
    min_ellipse_turn: float = np.radians(60.0)   # on a shorter arc an ellipse cannot be distinguished from a circle
    heading_base: float = 0.5   # m to either side over which the direction of a line is measured: vertices a decimetre apart are noisy
