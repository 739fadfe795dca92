#!/usr/bin/env bash
# Style, spelling, names that Qt 6 knows, and the two scans that QGIS's plugin repository makes of an upload: Bandit and detect-secrets.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
lint="$(realpath -m "$LANEWRIGHT_BUILD/lint")"  # venv refuses a link
stamp="$lint/.requirements"
if ! cmp -s requirements-lint.txt "$stamp"; then
  "$PY" -m venv "$lint"
  "$lint/bin/pip" install -q --disable-pip-version-check --cache-dir "$LANEWRIGHT_BUILD/pip" -r requirements-lint.txt
  cp requirements-lint.txt "$stamp"
fi
"$lint/bin/ruff" check --quiet .
"$lint/bin/codespell"
! git grep -nE '^(<{7}|>{7}) ' || exit 1  # left by a merge
git ls-files -z '*.py' '*.md' ':!docs/manual/de' | xargs -0 "$PY" tools/unwritten_words.py
"$lint/bin/mypy" --no-error-summary --python-executable "$LANEWRIGHT_BUILD/venv/bin/python"
# what is gone from Qt 6 or QGIS 4; QGS105: the interface is handed on, so that a test can hand on another
git ls-files -z '*.py' ':!tests' | xargs -0 "$lint/bin/flake8" --select QGS1,QGS4 --extend-ignore QGS105
git ls-files -z '*.py' ':!core' ':!products' ':!simulator' ':!tests/core' ':!tests/products' ':!tests/simulator' | xargs -0 "$lint/bin/python" tools/qt6_names.py
"$lint/bin/bandit" -q -c pyproject.toml -r .
git ls-files -z | xargs -0 "$lint/bin/detect-secrets-hook"
echo "No complaints."
