"""Makes `curbed_streets`, and the survey's `scanned_streets`, importable by the tests beside it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[1] / "survey"))
