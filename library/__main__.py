"""`python -m lanewright.library` is the program `lanewright`."""

import sys

from .command_line import main

sys.exit(main())
