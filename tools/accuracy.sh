#!/usr/bin/env bash
# The accuracy page of `make accuracy`; arguments go to tools/accuracy, for example: tools/accuracy.sh --surveys folder
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
export PYTHONPATH="$LANEWRIGHT_ROOT/tools"
exec "$LANEWRIGHT_BUILD/venv/bin/python" -m accuracy "$@"
