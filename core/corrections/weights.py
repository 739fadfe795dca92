"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from ..common.setting import table


@table
class CORRECTING:
    """What a correction of an analyst is about, and what it changes."""

    step: float = 0.25   # m between the places at which a line is compared with a correction
    shortest: float = 1.0   # m of a line along a correction that counts: a line that only crosses it does not
    shortest_rest: float = 0.5   # m: a shorter rest of a line goes with the stretch that is cut from it
    no_length: float = 1e-3   # m: sums of lengths differ in their last digits
    along: float = 0.5   # share of its length by which a stretch advances along the correction: one that crosses it does not
    moved_from: float = 2.0   # m beside its new place at most that a line is moved from; half of a lane is more than that
    near_vertices: float = 10.0   # m within which the map's own vertices tell the height of what was drawn
    height_neighbours: int = 8   # vertices whose heights are averaged, by the inverse of their distance
    taken_reach: float = 0.5   # m beside its place, of a lane that the estimate made as it was taken,
    taken_share: float = 0.8   # and share of its length
    most_lost: float = 0.5   # share of a curve that may be taken away before its elements go with it


@table
class PICK:
    """How a curb or a painted line is found about a click. The first four are the click's, the others those of one place across the line."""

    click_reach: float = 1.0   # m beside the click within which it is sought: at 1:500 that is 2 mm of the map
    section_reach: float = 0.3   # m beside a click in a section, which is nearer to what is meant,
    section_step: float = 0.02   # m, and shows lower steps
    fewest_places: int = 3   # along a face, a metre of it: a step at one place alone is a stone
    turn: float = 15.0   # degrees between the directions that are tried; half of it blurs a face over a strip of 1 m by 13 cm, less than a flank
    starts: int = 6   # directions from which a line is followed, the clearest first
    shortest: float = 2.0   # m of a line that is seen, at least: four places that agree are no chance
    near: float = 0.4   # m: of two the one that is nearer is meant; evidence weighs exp(-(distance / near)^2)
    step: float = 0.5   # m between places, and length of the strip that each takes points from, twice
    reach: float = 0.2   # m that the next place lies beside the course so far
    course: float = 3.0   # m of places behind, by which the course goes on
    tallest: float = 0.6   # m above the lowest points of a strip that ground may lie: cars and branches are left out
    flank: float = 0.3   # m of ground either side, through which a line is laid
    face: float = 0.08   # m either side of a face that count for neither flank; mountable curbs are 15 cm across
    knee: float = 0.2   # m beside a place, at least, that the lines of both sides meet: nearer they are the two sides of a ditch or a bank
    lowest_step: float = 0.03   # m, a dropped curb
    highest_step: float = 0.35   # m, a platform of buses; what is higher is a wall
    same: float = 2.0   # times that a step or a brightness may change from place to place on one line
    curb_gap: float = 2.0   # m that a curb may be hidden, as by the wheels of a car
    paint_gap: float = 9.0   # m between dashes, those of motorways
    dash_gap: float = 2.5   # m without paint from which a line is called dashed; shorter ones are wear
    brighter: float = 1.15   # times as bright as asphalt on both sides, at least
    certain: float = 6.0   # sigma of the difference of both sides, at least: some 200 candidates are looked at a place
    fewest: int = 5   # points of a flank or of a stripe
    most_points: int = 2_000_000   # of a window that are looked at: every second or third of a dense one tells as much in a part of the time
    noise: float = 0.002   # m, the least scatter of heights: rounding of files
