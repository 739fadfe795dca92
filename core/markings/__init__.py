"""What is painted.

In: road points and the intensity image, looked at in cells of 4 cm (`road_grid`). Out: paint points (`paint`, then `outliers`), markings as
polygons (`objects`), marking lines (`lines`), and the estimate that names lines and tells lanes and their directions (`cross_section`).
"""
