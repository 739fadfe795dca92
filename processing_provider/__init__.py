"""The algorithms of the toolbox: each file declares a dialog, calls one core function and writes the result."""
