#!/usr/bin/env bash
# Collects the texts into the .ts files and makes the .qm that QGIS loads; a language is added by naming it: tools/translations.sh fr
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
"$PY" tools/translations.py "$@"
lrelease="$(command -v lrelease || ls /usr/lib/qt5/bin/lrelease /usr/lib/qt6/bin/lrelease 2>/dev/null | head -n 1 || true)"
[ -n "$lrelease" ] || { echo "The .ts files are up to date; the .qm need Qt's lrelease: apt install qttools5-dev-tools" >&2; exit 2; }
"$lrelease" -silent resources/i18n/*.ts
