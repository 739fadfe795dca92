"""Pure Python: from point clouds and a trajectory to a road map. Never imports qgis.

The folders in the order of the work: `survey` (what was measured), `road` (where the road is),
`intensity` (what asphalt and paint return), `markings` (what is painted, and which lanes it makes), `driving` (where to drive),
`corrections` (what an analyst decided). `pipeline` runs them as one. Below them: `curves` (fitted curves), `countries` (what road
authorities prescribe), `io` (tables, CRS, rasters), `execution` (threads, worker processes or a cluster) and `common` (errors,
progress, layers in memory). What is made from a map stands in `products`, beside `core`; the simulated survey in `simulator`.
"""

# What `products` and `simulator` may use of the rooms of the chain; all else may change without a look at them
PUBLIC = {
    "survey.survey": ("Survey", "SurveySettings"),   # points of all sections in the road frame, and how they are read
    "survey.weights": ("LAS", "READING", "TRAJECTORY"),   # the numbers by which clouds and trajectories are read
    "survey.open_survey": ("match_clocks",),   # shift between the clocks of clouds and trajectory
    "survey.blocks": ("sensor_height_of",),   # sensor above the road
    "survey.trajectory.time_systems": ("SECONDS_PER_WEEK", "unwrap_week"),   # times beyond the end of a week
    "survey.trajectory.trajectory": ("Trajectory", "clean_trajectory", "reproject_trajectory"),   # positions of the vehicle
    "survey.estimation.estimate": ("EstimatedTrajectory", "WAYS"),   # the trajectory from the clouds alone
    "survey.frame.road_frame": ("Pass", "RoadFrame", "build_frame"),   # station, offset and height along roads, and single drives on them
    "survey.frame.projection": ("RoadProjection",),   # station and offset of many points
    "survey.frame.placement": ("FrameLines", "line_parts", "lines_in_frame"),   # lines of a layer in the road frame
    "survey.store.records": ("COORDINATE_SCALE", "Points"),   # points, whose coordinates are whole numbers of 0.1 mm
    "survey.store.columns": ("Columns",),   # records of points, column by column
    "survey.store.road_points": ("RoadPoints", "columns_of_roads"),   # points of the road, by section, and column by column
    "survey.las.reader": ("CloudHeader", "open_cloud", "read_blocks", "read_headers"),   # LAS, LAZ and COPC files
    # scanners and intensity of files, and points that are no noise
    "survey.las.point_fields": ("INTENSITY_SOURCES", "IntensitySource", "ScannerCensus", "in_one_scale", "intensity_source_of", "valid_points",
                                "without_intensity"),
    "survey.las.samples": ("coarse_coordinates", "distinct_rows", "may_overlap", "sample_files", "without_copies"),   # copies of points
    "survey.lattice.scan_lattice": ("find_lattice",),   # scan lines, numbered
    "survey.road_points_las": ("metres_of_file", "new_laz", "place_in_file"),   # new point clouds
    "road.common.pseudo_scanlines": ("lowest_layers",),   # the ground among the points of a cell
    "road.surface.ground_grid": ("MeasuredGround", "windows_of"),   # the ground in cells, stretch by stretch
    "road.weights": ("SURFACE",),   # the size of these cells
    "road.scanlines.grid": ("Scanlines",),   # normalized scanlines
    "road.scanlines.section_planes": ("ScanlineSettings", "all_scanlines"),   # which are made section by section
    "intensity.asphalt_model": ("asphalt_statistics",),   # level and spread of asphalt
    "markings.paint.asphalt_level": ("otsu",),   # threshold between two classes
    "markings.paint.settings": ("PaintMethod",),   # what another way to find paint looks like
    "markings.road_grid": ("occupied",),   # cells that hold points
    "driving.layers": ("Lanes",),   # lanes of a road map
}
