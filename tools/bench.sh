#!/usr/bin/env bash
# The benchmark of `make bench`; arguments go to tools/bench, for example: tools/bench.sh --quick
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
export PYTHONPATH="$LANEWRIGHT_ROOT/tools"
exec "$LANEWRIGHT_BUILD/venv/bin/python" -m bench "$@"
