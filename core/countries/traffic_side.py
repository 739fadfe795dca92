"""On which side traffic drives, by place on earth."""

from __future__ import annotations

from functools import cache

import numpy as np
import shapely

# Where traffic drives on the left (list of the UN Road Traffic Conventions of 1949 and 1968, distinguishing signs and sides of traffic), as rough
# outlines in degrees of longitude and latitude: British Isles; Malta; Cyprus; Indian subcontinent; Thailand, Malaysia, Indonesia, Australia, New
# Zealand and between; Hong Kong and Macao; Japan; Africa from Kenya to the Cape; Mauritius; Guyana and Suriname; Jamaica; Bahamas; Trinidad; Barbados
_LEFT = """MULTIPOLYGON(
((-11 49.7,-5 49.7,.3 50.4,1.45 51,2.2 52.8,.5 54,-.5 61.2,-8.8 60.5,-11 54,-11 49.7)),
((14.1 35.7,14.6 35.7,14.6 36.2,14.1 36.2,14.1 35.7)),((32.1 34.4,34.8 34.4,34.8 35.8,32.1 35.8,32.1 34.4)),
((61.5 25,61 29.5,66 30,69.5 32,71 34.5,71.5 36.3,74.5 36.9,77.5 35,79 32,81 30.2,88 27.9,89 28.2,92 27.8,97 28.2,97 27.5,94.5 24.8,93 22.5,
92.3 20.8,91 21,88 20.8,81 14.5,82.5 5.5,79 5.5,74 -1,71.5 8,72 19,67 23.5,61.5 25)),
((98 19.7,100 20.4,101.2 19.5,101 17.6,104 18.2,104.7 16.4,105.5 14.6,102.6 13.7,102.8 11.8,100.8 12.4,101 9.5,104 5,105.5 1.5,109 2.5,114 5.5,
116.8 7.4,119.6 5.2,119.5 3.5,127 4.2,129 2.5,141 -1,147 -2,156.5 -5,163 -9,163 -11,156 -15,156 -28,168 -33,179 -33,179.5 -48,166 -53,112 -45,112 -12,
100 -10,94.5 6.2,97.5 6.5,98 10,99 12.5,98.2 15,97.4 18.5,98 19.7)),
((113.5 22.1,114.5 22.1,114.5 22.5,113.5 22.5,113.5 22.1)),
((122.8 24,131 24,143 33,146.2 43,145.8 44.6,141 45.8,139 41,135.5 37,130.5 35.2,128.8 34,127.5 32.5,123 25.5,122.8 24)),
((11.7 -17.2,14 -17.4,23.3 -17.6,22 -16.3,22 -13,24 -13,24 -11.2,27.3 -12.3,29.8 -13.4,29.8 -12.2,28.5 -9.5,28.8 -8.5,30.8 -8.3,29.5 -6,29.4 -4.5,
30.8 -3,30.5 -1.1,29.7 0,30 2,31 3.7,34 4.2,36 4.4,41.9 3.9,41 -1.2,41.6 -1.7,41 -11,41.5 -15,36 -24,33 -30,20 -35.5,17 -33,11.7 -17.2)),
((57.2 -20.7,63.6 -20.7,63.6 -19.5,57.2 -19.5,57.2 -20.7)),((-61 7.5,-59.8 8.4,-54 6.1,-54.2 2.4,-57 2,-59.5 1.3,-60 5,-61 7.5)),
((-78.5 17.6,-76.1 17.6,-76.1 18.6,-78.5 18.6,-78.5 17.6)),((-79.4 23.8,-75.5 22,-72.6 20.8,-74 25,-77.5 27.4,-79.4 26.7,-79.4 23.8)),
((-62 10,-60.4 10,-60.4 11.4,-62 11.4,-62 10)),((-59.8 12.9,-59.3 12.9,-59.3 13.4,-59.8 13.4,-59.8 12.9)))"""
# small islands of many countries, where nothing is said: of the Caribbean and the Pacific
_MIXED = "MULTIPOLYGON(((-66 10,-59 10,-59 19,-66 19,-66 10)),((157 -25,180 -25,180 5,157 5,157 -25)),((-180 -25,-130 -25,-130 15,-180 15,-180 -25)))"


@cache
def side_of_traffic(longitude: float, latitude: float) -> str:
    """"right" or "left", the side of traffic at a place in degrees; "" where it is not known, as within 30 km of a border between the two."""
    place, left = shapely.Point(longitude, latitude), shapely.from_wkt(_LEFT.replace("\n", ""))
    if not np.isfinite([longitude, latitude]).all() or left.boundary.distance(place) < 0.3:
        return ""
    if left.contains(place):
        return "left"
    return "" if shapely.from_wkt(_MIXED).contains(place) else "right"
