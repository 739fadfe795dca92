"""What the plugin adds to the QGIS window: menu, manual, the widgets of its dialogs, the review of a map, and the map on paper."""
