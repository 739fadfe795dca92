"""Marking lines.

In: clustered paint points and markings. Out: edge, lane and centre lines as fitted curves, dashes linked, gaps said.
"""
