"""The numbers by which a survey is told to fit itself, each with where it comes from.

source : a standard or the law
derived : follows from another number or from how the thing is built
weight : our own estimate, rounded; beside it what it stands for
cost : decides how long the work takes, not what it says
"""

from __future__ import annotations

from ..adjustment.adjust import AGREEMENT_PLAN

# Vehicles
HALF_VEHICLE = 1.275     # source: m; no vehicle on the road is wider than 2.55 m (Directive 96/53/EC), so no scanner rides farther beside its middle
VEHICLE_HEIGHT = 4.0     # source: m (the same), so no scanner rides farther above or below a trajectory that is on the vehicle
LOWEST_SENSOR = 0.5      # weight: m above the road; no scanner rides lower, but lines and places drawn on the road lie within
USUAL_AHEAD = 3.0        # weight: m ahead of a trajectory on the same vehicle that scanners ride, one sigma

# Points from which places of scanners are found
TURNS_WINDOW = 0.05      # weight: s; every mirror turns a few times, and a vehicle on the road hardly sways
PLACES_READ = 6          # cost: places in the files that are looked at, and
PLACE_WINDOWS = 5        # cost: windows that points are read of at a place; the first and the last of them are not whole
PLACE_GAP = 2.0          # derived: s between windows, from which they are of another place, as PLACE_WINDOWS take far less
PLACE_POINTS = 50_000    # cost: that are read at a place, at most
MIN_TURNS_POINTS, MAX_TURNS_POINTS = 60, 200   # weight: of a window, with which four unknowns are found well; cost: those that are used
MIN_WINDOWS = 8          # weight: good ones that the place of a scanner needs
ATTITUDE_NOISE = 0.01    # weight: radians that roll, pitch and heading may be off, or differ from those of the way driven
MAX_UPRIGHT = 0.8        # weight: of the plane's normal; what lies flatter is the ground

# What one move of a trajectory may leave
ONE_MOVE, MOST = 0.20, 0.9   # weight: m at this share of the windows, as navigation drifts; more is the error of a drive by itself
CLEARLY_BETTER = 0.5     # weight: of what one move leaves, below which another is taken

# Where heights are in another unit or upside down, curbs are looked for at heights that they do not have. Their edges are then drawn along
# another line of the curb: its top, the back of its stone, the rim of its gutter. Nothing in such a survey says which, so that any place within
# the stone (15 cm: DIN 483, HB 15 × 30) and its gutter (30 cm are usual) is as likely
SIGMA_OF_OTHER_HEIGHTS = (0.15 + 0.30) / 12.0**0.5   # derived: m

# Scanners against each other
# cost: windows of the survey in which scanners are looked at, and measured, as an error of a mounting is the same in all
LOOK_WINDOWS, SCANNER_WINDOWS = 3, 16
# derived: m ahead, left and up that scanners may differ by without a move, as passes may; along lines nothing is drawn sharply
MAX_SCANNER_OFFSETS = 2 * AGREEMENT_PLAN, AGREEMENT_PLAN, AGREEMENT_PLAN / 2
SIGNIFICANT = 3.0        # derived: sigma; of a normal error one in 370 is larger
