#!/usr/bin/env bash
# Rebuilds the graphical models; see make_model.py.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
# One order of attributes, so that a diff shows what changed
export QT_HASH_SEED=0
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/make_model.py"
