#!/usr/bin/env bash
# An environment with dask.distributed from PyPI under build/cluster/, beside the packages of build/venv, and this checkout installed as its
# workers would have it. DISTRIBUTED is its version.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
here="$LANEWRIGHT_BUILD/cluster"
mkdir -p "$here"
DISTRIBUTED="${DISTRIBUTED:-2026.8.0}"

stamp="$here/.packages"
if [ ! -f "$stamp" ] || [ "$(cat "$stamp")" != "$DISTRIBUTED" ]; then
  rm -rf "$here/venv"
  "$PY" -m venv --system-site-packages "$here/venv"
  libraries="$("$here/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')"
  echo "$LANEWRIGHT_LIBS" >"$libraries/lanewright_build.pth"
  "$here/venv/bin/pip" install -q --disable-pip-version-check --cache-dir "$LANEWRIGHT_BUILD/pip" "distributed==$DISTRIBUTED"
  echo "$DISTRIBUTED" >"$stamp"
fi
"$here/venv/bin/pip" install -q --disable-pip-version-check --no-deps --no-build-isolation --force-reinstall .
