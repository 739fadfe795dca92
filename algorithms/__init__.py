"""The algorithms, declared once for every place they run in: QGIS Processing and the library outside QGIS.

Each file names an algorithm's parameters and outputs (`parameters`) and says which functions of the core do
its work; `call` describes what it is given to read values and to write results. Nothing here imports qgis.
"""
