"""Road edges.

In: curb points. Out: smooth lines, cut into pieces by what was measured and what was bridged.
"""
