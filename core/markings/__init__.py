"""What is painted: intensity, image, thresholds, outliers, clusters, lines."""
