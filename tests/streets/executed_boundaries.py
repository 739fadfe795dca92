"""Boundaries of a made street, found by any executor, and what of them must be the same to the last bit."""

from curbed_streets import parked_car, street, survey_of
from lanewright.core.common.progress import Progress
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points


def boundaries(executor, method="both", progress=Progress(), **ground):
    """What is found on a street with an opening and a parked car; `ground` goes to `street`. The executor is closed."""
    survey = survey_of(parked_car(street(open_left=[(25.0, 33.0)], **ground), start=40.0))
    survey.executor = executor
    try:
        return draw_boundaries(find_curb_points(survey, BoundarySettings(method), progress), survey.frame)
    finally:
        survey.store.close()
        executor.close()


def numbers_of(found):
    """All numbers of curb points and edges as bytes, and their words."""
    course, points = found.edges.course, found.curb_points
    columns = [course.x, course.y, course.z, course.s, course.d, found.edges.agree, found.edges.rmse, found.edges.chain, found.edges.nearest_pass,
               points.x, points.y, points.z, points.station, points.offset, points.height, points.support]
    return [column.tobytes() for column in columns], list(points.status), list(points.kind), list(found.edges.status)
