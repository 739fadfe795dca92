"""Lanewright without QGIS: numpy, roads and nothing of the desktop."""
