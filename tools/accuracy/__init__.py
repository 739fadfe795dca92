"""`make accuracy`: every method over surveys with truth, into docs/accuracy.md beside the published figures.

surveys (what is measured on) → chain (what is run) → judge (how right it is) → figures
(all numbers of one survey) → results (one table of all figures, docs/accuracy.csv) → page (what is quoted of it, in page.md).
Beside the steps, the road map as a whole: otherwise (of a street and of its variants) and poorer (with something lacking) →
streets (how right it is, by length).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from plugin_package import ROOT, load  # noqa: E402, F401

load()
