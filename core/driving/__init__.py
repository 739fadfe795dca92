"""Where to drive.

In: marking lines, with markings, edges and road points where there are any. Out: lanes, driving lines and their curve elements.
"""
