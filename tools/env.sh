# Sourced by the tools beside it: where everything of this checkout lives, and a QGIS of its own.
# Nothing outside build/ is read or written, so a user's QGIS profile is never touched.

LANEWRIGHT_ROOT="$(cd -P "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
LANEWRIGHT_BUILD="$LANEWRIGHT_ROOT/build"
PY=/usr/bin/python3 # QGIS's own; another python3 on PATH cannot import qgis
# Python inside QGIS takes the first python3 on PATH for its home, and with that of pyenv or conda it dies.
export PATH="$(dirname "$PY"):$PATH"

export QT_QPA_PLATFORM=offscreen
export XDG_RUNTIME_DIR="$LANEWRIGHT_BUILD/run"
export QGIS_CUSTOM_CONFIG_PATH="$LANEWRIGHT_BUILD/profile"
export QGIS_PLUGINPATH="$LANEWRIGHT_BUILD/plugins"
unset PYTHONDONTWRITEBYTECODE
export PYTHONPYCACHEPREFIX="$LANEWRIGHT_BUILD/pycache"
[ -d /usr/share/proj ] && export PROJ_DATA=/usr/share/proj
# numpy's threads gain nothing on these arrays and cost a core each.
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}" OPENBLAS_NUM_THREADS="${OPENBLAS_NUM_THREADS:-1}"
unset PYTHONPATH PYTHONHOME VIRTUAL_ENV

LANEWRIGHT_LIBS="$(echo "$LANEWRIGHT_BUILD"/venv/lib/python3*/site-packages)"
export LANEWRIGHT_LIBS
