"""From the road map to the formats of simulators, planners and design offices, back again, and their check.

In: `Lanes` with the layers of the road map, or a file of OpenDRIVE or Lanelet2. Out: such a file, DXF or LandXML; lanes and lines like
ours; findings on a map.
"""
