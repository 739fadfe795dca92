"""Points by road section: memory up to a limit, then a temporary file.

In: compact point records in any order. Out: the points of one section, in an order that does not depend on the files.
"""
