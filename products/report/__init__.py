"""Reports: one HTML page per run, complete in itself, with numbers, charts and maps.

In: the result of an algorithm. Out: the text of an HTML file.
"""
