"""The algorithms in QGIS: dialogs made from their declarations, layers read and written, styles."""
