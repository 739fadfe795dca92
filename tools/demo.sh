#!/usr/bin/env bash
# The demo of `make demo`: a sample survey, the whole chain through the real qgis_process, a map.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/demo.py" "$@"
