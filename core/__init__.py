"""Pure Python: from point clouds and a trajectory to a road map. Never imports qgis.

The folders in the order of the work: `survey` (what was measured), `road` (where the road is),
`intensity` (what asphalt and paint return), `markings` (what is painted), `driving` (where to drive),
`assess` (how good it is). `pipeline` runs them as one. Beside them: `curves` (fitted curves),
`overlay` (UAV images), `report` (HTML pages), `sample` (a simulated survey with known truth),
`io` (tables, CRS, rasters) and `common` (errors, progress, threads, layers in memory).
"""
