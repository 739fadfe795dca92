"""Where to drive: driving lines and their curve elements."""
