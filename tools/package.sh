#!/usr/bin/env bash
# The release zip: only committed files, in one folder named as QGIS names the plugin. For QGIS's plugin repository the
# addresses of the publisher go in: REPOSITORY=https://… EMAIL=me@… [HOMEPAGE=…] [TRACKER=…] tools/package.sh
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
version="$(sed -n 's/^version=//p' metadata.txt)"
zip="${1:-dist/lanewright-$version.zip}"
mkdir -p "$(dirname "$zip")"
git archive --format=zip --prefix=lanewright/ -o "$zip" HEAD
if [ -n "${REPOSITORY:-}" ] && [ -n "${EMAIL:-}" ]; then
  "$PY" tools/addresses.py "$zip" "$REPOSITORY" "$EMAIL" "${HOMEPAGE:-}" "${TRACKER:-}" || { rm -f "$zip" "${zip%.zip}.unaddressed"; exit 1; }
else
  echo "For “Install from ZIP”. For plugins.qgis.org name the publisher: make package REPOSITORY=https://… EMAIL=me@…" >&2
fi
echo "$zip"
