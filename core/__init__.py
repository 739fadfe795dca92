"""Pure Python: from point clouds and a trajectory to a road map. Never imports qgis.

The folders in the order of the work: `survey` (what was measured), `road` (where the road is),
`intensity` (what asphalt and paint return), `markings` (what is painted, and which lanes it makes), `driving` (where to drive),
`corrections` (what an analyst decided). `pipeline` runs them as one. Below them: `curves` (fitted curves), `countries` (what road
authorities prescribe), `io` (tables, CRS, rasters), `execution` (threads, worker processes or a cluster) and `common` (errors,
progress, layers in memory). What is made from a map stands in `products`, beside `core`; the simulated survey in `simulator`.
"""
