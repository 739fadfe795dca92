#!/usr/bin/env bash
# The tests, in three processes: the core where qgis cannot be imported, then the plugin inside QGIS,
# then calls of the real qgis_process. Arguments go to pytest, for example: tools/test.sh -k curbs
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
python="$LANEWRIGHT_BUILD/venv/bin/python"
# With -k a part may have nothing to run (pytest says 5); without arguments that is a failure.
run() {
  "$@" && return 0
  local code=$?
  [ "$code" -eq 5 ] && [ "$chosen" -gt 0 ] && return 0
  return "$code"
}
chosen=$#

echo "== core, where qgis cannot be imported"
run "$python" -c 'import sys; sys.modules["qgis"] = None; import pytest; sys.exit(pytest.main(sys.argv[1:]))' \
  -q -p no:pytest_qgis -o addopts='--import-mode=importlib -p no:cacheprovider' tests/core "$@"
echo "== the plugin inside QGIS"
run "$python" -m pytest -q tests --ignore tests/core --ignore tests/cli "$@"
echo "== real qgis_process"
run "$python" -m pytest -q tests/cli "$@"
