#!/usr/bin/env bash
# The manual's pages of `make manual`; see make_manual.py.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/make_manual.py" "$@"
