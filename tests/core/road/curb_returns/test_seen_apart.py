"""What a scanner on a vehicle shows of the ground: none beneath itself, and faces blurred by the drift from one view to the next."""

import numpy as np
import shapely
from lanewright.core.road.common.curb_limits import CurbSettings
from lanewright.core.road.curb_returns.classify import is_curb_like
from lanewright.core.road.curb_returns.detect import _averaged_views
from lanewright.core.road.curb_returns.ground_raster import driven_ground, ground_raster, ground_slopes
from lanewright.core.road.curb_returns.steps import PlanSteps, measure_plan_steps, step_places
from lanewright.core.road.curb_returns.tracking import PlanStepChain
from street_plans import scan

NOWHERE = np.empty((2, 0))


def test_ground_beside_what_the_vehicle_hides_is_connected_with_its_track():
    x, y = (v.ravel() for v in np.meshgrid(np.arange(0, 20, 0.05), np.arange(-8, 8, 0.05)))
    seen = np.abs(y) > 2.0
    raster = ground_raster(x[seen], y[seen], np.zeros(seen.sum()), 0.05)
    track = np.arange(0, 20, 0.08)
    driven, _ = driven_ground(raster, ground_slopes(raster.low), track, 0 * track, NOWHERE, *NOWHERE, 0.05)
    assert driven[raster.inside([10.0, 10.0], [-5.0, 5.0])].all()


def test_a_line_with_hardly_any_ground_behind_it_is_the_foot_of_a_wall():
    along, ones = np.arange(0.0, 6.0, 0.3), np.ones(20)

    def is_curb(behind):
        steps = PlanSteps(along, 0 * along, 0 * along, ones, 0 * along, 0.15 * ones, 0 * along, 0.004 * ones, 80 * ones, behind * ones)
        return is_curb_like(PlanStepChain(np.arange(20)), steps, 0.004 * ones, CurbSettings())

    assert is_curb(60) and is_curb(15)
    assert not is_curb(5)


def test_a_face_is_measured_though_far_and_near_views_of_it_lie_apart():
    raised = shapely.box(-50, -50, 50, 0)   # its curb lies along y = 0
    x, y, z, _ = scan(raised, spacing=0.02, noise=0.012, within=(10.0, -3.0, 20.0, 3.0))
    along = np.random.default_rng(1).uniform(-10, 10, len(x))
    y = y + np.where(np.abs(along) > 5, 0.08, -0.08)
    raster = ground_raster(x, y, z, 0.05)
    slopes = ground_slopes(raster.low)
    road = np.ones(raster.low.shape, bool)
    places = step_places(raster, slopes, road, road, 0.05, 0.35)
    steps = measure_plan_steps(_averaged_views(raster, (x, y, z), along, 0.05), *places, 0.025, 0.35)
    assert len(np.unique(np.round(steps.x))) >= 9
