#!/usr/bin/env bash
# The benchmark of `make bench`; arguments go to tools/bench.py, for example: tools/bench.sh --sizes 5000000
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/bench.py" "$@"
