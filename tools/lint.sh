#!/usr/bin/env bash
# Style, spelling, and the two scans that QGIS's plugin repository makes of an upload: Bandit and detect-secrets.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
lint="$LANEWRIGHT_BUILD/lint"
stamp="$lint/.requirements"
if ! cmp -s requirements-lint.txt "$stamp"; then
  "$PY" -m venv "$lint"
  "$lint/bin/pip" install -q --disable-pip-version-check --cache-dir "$LANEWRIGHT_BUILD/pip" -r requirements-lint.txt
  cp requirements-lint.txt "$stamp"
fi
"$lint/bin/ruff" check --quiet .
"$lint/bin/codespell"
"$lint/bin/mypy" --no-error-summary --python-executable "$LANEWRIGHT_BUILD/venv/bin/python"
"$lint/bin/bandit" -q -c pyproject.toml -r .
git ls-files -z | xargs -0 "$lint/bin/detect-secrets-hook"
echo "No complaints."
