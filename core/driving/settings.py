"""What a user may say about lanes."""

from dataclasses import dataclass

from ..common.errors import RoadExtractionError
from ..common.setting import check_limits, setting
from ..countries.catalogue import NEUTRAL, country

MIN_LANE_WIDTH, MAX_LANE_WIDTH = NEUTRAL.narrowest_lane, NEUTRAL.widest_lane  # m between the lines of a lane, in any country
TRAFFIC_SIDES = ("automatic", "right", "left")


@dataclass(frozen=True)
class DrivingSettings:
    """Lengths in metres.

    lane_width : how wide lanes are; 0 takes the width seen between lines, the usual one of the country where there is none
    line_distance : driving line to a line without partner; 0 is half a lane
    max_bridge : gaps of all lines (crossings, stop lines) longer than this stay open
    """

    lane_width: float = setting(0.0, MIN_LANE_WIDTH, MAX_LANE_WIDTH, "The lane width", "m", "to take the width from the lines themselves")
    line_distance: float = setting(0.0, 0.3, MAX_LANE_WIDTH, "The distance from a line", "m", "for half a lane")
    traffic_side: str = "automatic"   # the side of the road that is driven on; automatic asks the trajectory
    max_bridge: float = setting(20.0, 0.0, 200.0, "The longest gap of all lines that is bridged", "m")
    shortest: float = setting(8.0, 0.0, 200.0, "The shortest driving line", "m")   # shorter driving lines are not worth a line
    country: str = NEUTRAL.name   # whose design code curves are checked against; one of core.countries.COUNTRIES

    def __post_init__(self):
        check_limits(self)
        country(self.country)
        if self.traffic_side not in TRAFFIC_SIDES:
            raise RoadExtractionError(f"There is no traffic side called {self.traffic_side!r}. Choose one of {', '.join(TRAFFIC_SIDES)}.")
