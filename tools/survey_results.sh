#!/usr/bin/env bash
# Road maps of many surveys with default parameters, for example: tools/survey_results.sh results --surveys folder
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
exec "$LANEWRIGHT_BUILD/venv/bin/python" "$LANEWRIGHT_ROOT/tools/survey_results.py" "$@"
