#!/usr/bin/env bash
# The release zip: only committed files, in one folder named as QGIS names the plugin.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
version="$(sed -n 's/^version=//p' metadata.txt)"
zip="${1:-dist/lanewright-$version.zip}"
mkdir -p "$(dirname "$zip")"
git archive --format=zip --prefix=lanewright/ -o "$zip" HEAD
echo "$zip"
