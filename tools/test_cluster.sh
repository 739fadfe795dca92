#!/usr/bin/env bash
# Phases on a real Dask cluster on this computer, a scheduler and two workers of its own making, in the environment of
# cluster_environment.sh. Arguments go to pytest.
set -euo pipefail
tools="$(dirname "${BASH_SOURCE[0]}")"
"$tools/cluster_environment.sh"
source "$tools/env.sh"
cd "$LANEWRIGHT_ROOT"
LANEWRIGHT_WITHOUT_QGIS=1 "$LANEWRIGHT_BUILD/cluster/venv/bin/python" -m pytest -q -p no:pytest_qgis -o addopts='--import-mode=importlib -p no:cacheprovider' tests/cluster "$@"
