"""`make accuracy`: every method over surveys with truth, into docs/accuracy.md beside the published figures.

surveys (what is measured on) → chain (what is run) → judge (how right it is) → figures
(all numbers of one survey) → page (the document). Beside the steps, the road map as a whole: otherwise (of a street
and of its variants) and poorer (with something lacking) → streets (how right it is, by length) → streets_page, poorer_page.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from plugin_package import ROOT, load  # noqa: E402, F401

load()
