#!/usr/bin/env bash
# Style, spelling, types, names that QGIS and Qt 6 know, and the scans that QGIS's plugin repository makes of an upload: Bandit, detect-secrets,
# flake8 (what it checks of files is in tests/packaging/test_release.py).
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
# Names and arguments that QGIS does not know. Left out: what its Python adds to classes, and base classes in place of which one gets others
(cd "$LANEWRIGHT_BUILD/plugins" && "$lint/bin/mypy" --config-file= --check-untyped-defs --ignore-missing-imports --follow-imports=silent \
  --cache-dir="$lint/stubs" -p lanewright.desktop -p lanewright.processing_provider >"$lint/unknown.txt") || [ $? = 1 ]
! grep -E '"(Qgs|type\[).*\[(attr-defined|union-attr|call-overload)\]$' "$lint/unknown.txt" | grep -vE 'Item "None"|"__iter__"|Exception"|type\[(ProcessingSourceType|CustomRole)'\
'|"Qgs(MapLayer|Abstract\w+|LayerTreeNode|Symbol|RasterRenderer|Processing(ParameterDefinition|Algorithm))"( of "[^"]*")? has' || exit 1
# QGS: what is gone from Qt 6 or QGIS 4 (105: the interface is handed on, so that a test can hand on another); the others as the plugin repository asks
git ls-files -z '*.py' ':!tests' | xargs -0 "$lint/bin/flake8" --select QGS1,QGS4,E101,E7,E9,W605,F4,F8,F9 --extend-ignore QGS105
git ls-files -z '*.py' ':!core' ':!products' ':!simulator' ':!tests/core' ':!tests/products' ':!tests/simulator' | xargs -0 "$lint/bin/python" tools/qt6_names.py
"$lint/bin/bandit" -q -c pyproject.toml -r .
git ls-files -z | xargs -0 "$lint/bin/detect-secrets-hook"
echo "No complaints."
