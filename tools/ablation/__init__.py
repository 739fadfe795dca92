"""`make ablation`: every special rule, method and kind of evidence switched off in turn, over surveys with truth.

switches (the one table of what is switched off) → swap (what stands in its place, and whether a survey calls it at all) → measure (the road
map without it, from the first stage on that changes) → weight (its lines and numbers) → page (a table as CSV and as Markdown).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from accuracy import ROOT  # noqa: E402, F401
