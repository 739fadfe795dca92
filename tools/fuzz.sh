#!/usr/bin/env bash
# Every reader fed with broken files (fuzz.py), led by coverage where atheris can be installed: into an environment of its own, build/fuzz/venv.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
fuzz="$(realpath -m "$LANEWRIGHT_BUILD/fuzz")" # venv refuses a link
if ! cmp -s requirements-fuzz.txt "$fuzz/.requirements"; then
  "$PY" -m venv --system-site-packages "$fuzz/venv"
  "$fuzz/venv/bin/python" -m pip install -qq --disable-pip-version-check --cache-dir "$LANEWRIGHT_BUILD/pip" --no-deps --only-binary :all: \
    -r requirements-fuzz.txt 2>/dev/null || echo "pip has no atheris for $("$PY" -V) here."
  echo "$LANEWRIGHT_LIBS" >"$(echo "$fuzz"/venv/lib/python3*/site-packages)/lanewright.pth"
  cp requirements-fuzz.txt "$fuzz/.requirements"
fi
exec "$fuzz/venv/bin/python" tools/fuzz.py "$@"
