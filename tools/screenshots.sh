#!/usr/bin/env bash
# Drives a real QGIS window on a screen of its own (Xvfb), in English and in German, and keeps what it shows in docs/manual/img and
# docs/manual/de/img: the dialogs, the sample survey's road map, and the tasks of a surveyor from own files to a database.
# LANEWRIGHT_STEPS="sample doubts" does some of the steps only, LANEWRIGHT_LANG=de one of the languages.
# Ends with an error when a window does not come up or a layer is missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
command -v Xvfb >/dev/null || { echo "Install xvfb first: apt install xvfb" >&2; exit 2; }
manual="${1:-$LANEWRIGHT_ROOT/docs/manual}"
export LANEWRIGHT_ROOT QT_QPA_PLATFORM=xcb LANEWRIGHT_SAID="$LANEWRIGHT_BUILD/screenshots.txt"
# A profile of its own: what is clicked here stays out of the other tools' profile
export QGIS_CUSTOM_CONFIG_PATH="$LANEWRIGHT_BUILD/window-profile"
number=$((90 + RANDOM % 400))
Xvfb ":$number" -screen 0 1400x900x24 >/dev/null 2>&1 &
screen=$!
trap 'kill $screen 2>/dev/null || true' EXIT
sleep 1
for language in ${LANEWRIGHT_LANG:-en de}; do
  export LANEWRIGHT_PICTURES="$manual/img" LANEWRIGHT_LANG="$language"
  [ "$language" = en ] || LANEWRIGHT_PICTURES="$manual/$language/img"
  mkdir -p "$LANEWRIGHT_PICTURES"
  rm -rf "$QGIS_CUSTOM_CONFIG_PATH" "$LANEWRIGHT_SAID"
  QT_QPA_PLATFORM=offscreen qgis_process plugins enable lanewright >/dev/null 2>&1
  DISPLAY=":$number" LANG="$language.UTF-8" timeout 1800 qgis --nologo --noversioncheck --lang "$language" \
    --code "$LANEWRIGHT_ROOT/tools/screenshots.py" >"$LANEWRIGHT_BUILD/screenshots.log" 2>&1 || true
  cat "$LANEWRIGHT_SAID" 2>/dev/null
  grep -q '^finished$' "$LANEWRIGHT_SAID" 2>/dev/null ||
    { tail -n 20 "$LANEWRIGHT_BUILD/screenshots.log" >&2; echo "The window was not driven to the end ($language)." >&2; exit 1; }
done
