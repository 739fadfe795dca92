"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
