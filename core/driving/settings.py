"""What a user may say about lanes."""

from dataclasses import dataclass

from ..errors import RoadExtractionError

NARROWEST = 2.2  # m between the lines of a lane
WIDEST = 5.0
USUAL = 3.5      # where no lane of the road shows its width
SIDES = ("automatic", "right", "left")


@dataclass(frozen=True)
class DrivingSettings:
    """Lengths in metres.

    lane_width : how wide a lane is where only outer lines are painted, or only one line;
        0 takes the width seen elsewhere on the road, 3.5 m where there is none
    line_distance : driving line to a line without partner; 0 is half a lane
    traffic_side : the side of the road that is driven on; automatic asks the trajectory
    max_bridge : gaps of all lines (crossings, stop lines) longer than this stay open
    max_inferred : gaps through which some other line of the road leads are closed up to this
    shortest : shorter driving lines are not worth a line
    """

    lane_width: float = 3.5
    line_distance: float = 0.0
    traffic_side: str = "automatic"
    max_bridge: float = 20.0
    max_inferred: float = 60.0
    shortest: float = 8.0

    def __post_init__(self):
        if self.lane_width and not NARROWEST <= self.lane_width <= WIDEST:
            raise RoadExtractionError(
                f"The lane width is {self.lane_width} m; lanes are {NARROWEST} to {WIDEST} m wide. "
                "Set 0 to take the width from the lines themselves.")
        if self.line_distance and not 0.3 <= self.line_distance <= WIDEST:
            raise RoadExtractionError(
                f"The distance from a line is {self.line_distance} m; it must be 0.3 to {WIDEST} m, or 0 for half a lane.")
        if self.traffic_side not in SIDES:
            raise RoadExtractionError(
                f"There is no traffic side called {self.traffic_side!r}. Choose one of {', '.join(SIDES)}.")
        if min(self.max_bridge, self.max_inferred, self.shortest) < 0:
            raise RoadExtractionError("Lengths of gaps and lines must not be negative.")
