"""`make bench`: how long each stage takes beside the programs people know, into docs/benchmarks.md.

surveys (what is measured on) → prepare (the points that peers get too) → measures (ours) and
peer_measures (theirs), each in a process of its own → rounds (in turns, several times) →
meaning (do both say the same?) → rows (the goals) → results (one table of all figures, docs/benchmarks.csv) →
page (what is quoted of it, in page.md).
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from plugin_package import ROOT, load  # noqa: E402, F401

load()
BUILD = ROOT / "build" / "bench"
