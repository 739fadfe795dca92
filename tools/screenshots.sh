#!/usr/bin/env bash
# Drives a real QGIS window on a screen of its own (Xvfb) and keeps what it shows in docs/manual/img:
# the toolbox, the road map dialog, the sample survey's road map, its layout, the model designer.
# LANEWRIGHT_STEPS="sample doubts" does some of the steps only.
# Ends with an error when a window does not come up or a layer is missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
command -v Xvfb >/dev/null || { echo "Install xvfb first: apt install xvfb" >&2; exit 2; }
pictures="${1:-$LANEWRIGHT_ROOT/docs/manual/img}"
mkdir -p "$pictures"
export LANEWRIGHT_ROOT LANEWRIGHT_PICTURES="$pictures" QT_QPA_PLATFORM=xcb LANG="${LANEWRIGHT_LANG:-en_US.UTF-8}"
rm -f "$LANEWRIGHT_BUILD/screenshots.txt"
export LANEWRIGHT_SAID="$LANEWRIGHT_BUILD/screenshots.txt"
# A profile of its own: what is clicked here stays out of the other tools' profile
export QGIS_CUSTOM_CONFIG_PATH="$LANEWRIGHT_BUILD/window-profile"
rm -rf "$QGIS_CUSTOM_CONFIG_PATH"
QT_QPA_PLATFORM=offscreen qgis_process plugins enable lanewright >/dev/null 2>&1
number=$((90 + RANDOM % 400))
Xvfb ":$number" -screen 0 1400x900x24 >/dev/null 2>&1 &
screen=$!
trap 'kill $screen 2>/dev/null || true' EXIT
sleep 1
DISPLAY=":$number" timeout 600 qgis --nologo --noversioncheck --lang "${LANEWRIGHT_LANG:-en}" \
  --code "$LANEWRIGHT_ROOT/tools/screenshots.py" >"$LANEWRIGHT_BUILD/screenshots.log" 2>&1 || true
cat "$LANEWRIGHT_SAID" 2>/dev/null
grep -q '^finished$' "$LANEWRIGHT_SAID" 2>/dev/null ||
  { tail -n 20 "$LANEWRIGHT_BUILD/screenshots.log" >&2; echo "The window was not driven to the end." >&2; exit 1; }
