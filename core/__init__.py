"""Pure Python: from point clouds and a trajectory to a road map. Never imports qgis.

The folders in the order of the work: `survey` (what was measured), `road` (where the road is),
`intensity` (what asphalt and paint return), `markings` (what is painted, and which lanes it makes), `driving` (where to drive),
`corrections` (what an analyst decided), `inventory` (what else the road shows), `export` (HD maps and CAD), `assess` (how good
it is). `pipeline` runs them as one. Beside them: `curves` (fitted curves), `countries` (what road authorities prescribe),
`execution` (threads, worker processes or a cluster), `overlay` (UAV images), `report` (HTML pages), `sample` (a simulated survey
with known truth), `io` (tables, CRS, rasters) and `common` (errors, progress, layers in memory).
"""
