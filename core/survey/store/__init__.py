"""Points by road section, in files that every thread, process and machine maps into memory.

In: compact point records in any order. Out: the points of one section, in an order that does not depend on the files.
"""
