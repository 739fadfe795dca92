"""What a user may say about lanes."""

from dataclasses import dataclass

from ..common.setting import Limited, choice, setting
from ..countries.catalogue import COUNTRIES, NEUTRAL, country

MIN_LANE_WIDTH, MAX_LANE_WIDTH = NEUTRAL.narrowest_lane, NEUTRAL.widest_lane  # m between the lines of a lane, in any country


@dataclass(frozen=True)
class DrivingSettings(Limited):
    """Lengths in metres.

    lane_width : how wide lanes are; 0 takes the width seen between lines, the usual one of the country where there is none
    line_distance : driving line to a line without partner; 0 is half a lane
    max_bridge : gaps of all lines (crossings, stop lines) longer than this stay open
    """

    lane_width: float = setting(0.0, MIN_LANE_WIDTH, MAX_LANE_WIDTH, "The lane width", "m", "to take the width from the lines themselves")
    line_distance: float = setting(0.0, 0.3, MAX_LANE_WIDTH, "The distance from a line", "m", "for half a lane")
    # the side of the road that is driven on; automatic asks the trajectory
    traffic_side: str = choice("automatic", ("automatic", "right", "left"), "The side of traffic")
    max_bridge: float = setting(20.0, 0.0, 200.0, "The longest gap of all lines that is bridged", "m")
    shortest: float = setting(8.0, 0.0, 200.0, "The shortest driving line", "m")   # shorter driving lines are not worth a line
    country: str = choice(NEUTRAL.name, COUNTRIES, "The country")   # whose design code curves are checked against

    @property
    def usual_width(self) -> float:
        """m, of lanes where the lines do not tell."""
        return self.lane_width or country(self.country).usual_lane
