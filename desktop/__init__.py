"""What the plugin adds to the QGIS window: menu, toolbar button, manual and map layout."""
