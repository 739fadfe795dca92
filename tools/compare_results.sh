#!/usr/bin/env bash
# Are two folders of results the same? For example: tools/compare_results.sh before after --tolerance 0.001
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/compare_results.py" "$@"
