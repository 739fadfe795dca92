"""Reports: one HTML page a run, complete in itself, with numbers and pictures."""
