#!/usr/bin/env bash
# HD maps of streets with known lanes, read by other people's libraries, each in an environment of its own under build/hdmap:
# asam-qc-opendrive (schema and links; it wants numpy 1), pyxodr, lanelet2, ezdxf, and CARLA's map library, which needs no server.
# RESULTS=folder takes the road maps of tools/survey_results.sh in that folder as well.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
here="$LANEWRIGHT_BUILD/hdmap"
mkdir -p "$here"

environment() { # name, packages
  local folder="$here/$1" stamp="$here/$1/.packages"
  shift
  [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$*" ] && return
  rm -rf "$folder"
  "$PY" -m venv "$folder" &&
    "$folder/bin/pip" install -q --disable-pip-version-check --cache-dir "$LANEWRIGHT_BUILD/pip" "$@" &&
    echo "$*" >"$stamp"
}
environment readers pyxodr==0.1.3 lanelet2==1.2.3 ezdxf==1.4.5
environment qc asam-qc-opendrive==1.0.0

# the library has a wheel for some versions of Python on Linux and Windows alone
carla=yes
environment carla carla==0.9.16 numpy shapely || { carla=; rm -rf "$here/carla"; }

rm -rf "$here/files"
"$LANEWRIGHT_BUILD/venv/bin/python" tools/hdmap/make_files.py "$here/files" ${RESULTS:+"$RESULTS"}
"$here/readers/bin/python" tools/hdmap/read_maps.py "$here/files"
if [ -n "$carla" ]; then
  "$here/carla/bin/python" tools/hdmap/drive_maps.py "$here/files" 2>/dev/null
else
  echo "carla: no wheel for $("$PY" --version) on $(uname -sm); its part of the test was left out" >&2
fi
issues=0
for file in "$here/files"/*.xodr; do
  printf '<Config><Param name="InputFile" value="%s"/><CheckerBundle application="xodrBundle"><Param name="resultFile" value="%s"/></CheckerBundle></Config>' \
    "$file" "$file.xqar" >"$file.config"
  "$here/qc/bin/python" -m qc_opendrive -c "$file.config" >"$file.log" 2>&1 || { tail -n 5 "$file.log"; exit 1; }
  found="$(grep -c '<Issue' "$file.xqar" || true)"
  [ "$found" -eq 0 ] || { echo "asam-qc: $found issues in $(basename "$file")"; grep -o '<Issue[^>]*' "$file.xqar" | head -n 5; }
  issues=$((issues + found))
done
echo "asam-qc: $issues issues in $(ls "$here/files"/*.xodr | wc -l) files"
[ "$issues" -eq 0 ]
