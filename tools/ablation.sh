#!/usr/bin/env bash
# The table of `make ablation`; arguments go to tools/ablation, for example: tools/ablation.sh --scenes crossing --rules lines --variants mirrored
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
export PYTHONPATH="$LANEWRIGHT_ROOT/tools"
exec "$LANEWRIGHT_BUILD/venv/bin/python" -m ablation "$@"
