#!/usr/bin/env bash
# Measures the boundaries of sample surveys over interval, density and speed; writes the table and the figure of docs/scanlines.md.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/scanline_figure.py" "$@"
