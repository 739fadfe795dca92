#!/usr/bin/env bash
# Everything Lanewright needs on a Debian machine: QGIS 3.40 or newer, the Python packages, a profile
# of its own with the plugin enabled. Safe to run again: what is there already is left alone, and a
# finished set-up is recognised by a stamp in well under a second.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"

OLDEST=3.40
NEWER="Debian 12 has 3.40 in bookworm-backports, Debian 13 has it itself, and https://qgis.org/download serves other systems"
PACKAGES=(ca-certificates fonts-dejavu-core gdal-bin make python3-fiona python3-jinja2 python3-numpy python3-opencv python3-pip
  python3-pyproj python3-pytest python3-scipy python3-setuptools python3-venv python3-wheel)
TESTED_WITH=(postgresql postgresql-postgis) # the tests start a server of their own, in a folder that goes afterwards

qgis_version() { qgis_process --version 2>/dev/null | sed -nE 's/^QGIS ([0-9]+\.[0-9]+).*/\1/p' | head -n 1; }
at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }
stop() { echo "$1" >&2; exit 2; }

stamp_now() {
  { cat tools/setup.sh tools/env.sh requirements-dev.txt; qgis_process --version 2>/dev/null | head -n 1; "$PY" -V; pwd; } |
    sha256sum | cut -d ' ' -f 1
}
stamp="$LANEWRIGHT_BUILD/.setup"
if [ -f "$stamp" ] && command -v qgis_process >/dev/null && [ -x "$LANEWRIGHT_BUILD/venv/bin/python" ] &&
  [ -e "$LANEWRIGHT_BUILD/plugins/lanewright/metadata.txt" ] && [ "$(cat "$stamp")" = "$(stamp_now)" ]; then
  exit 0
fi

have_python_packages() { # setuptools first: it does not come after another that imports distutils
  [ -x "$PY" ] && "$PY" -c 'import setuptools, cv2, ensurepip, fiona, numpy, osgeo.gdal, pip, pyproj, pytest, scipy, venv, wheel, qgis.core' 2>/dev/null
}

# As root, through sudo, or not at all: then the exact command is printed for whoever may run it.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
    sudo "$@"
  else
    return 1
  fi
}

install_script() { # the shell lines that install from $1 ("" or a release such as bookworm-backports)
  local release="$1" from=""
  echo "set -e"
  echo "export DEBIAN_FRONTEND=noninteractive"
  if [ -n "$release" ]; then
    from="-t $release "
    if [ "$add_backports" = yes ]; then
      echo "echo 'deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $mirror $release main' > /etc/apt/sources.list.d/$release.list"
    fi
  fi
  echo "apt-get update -q"
  echo "apt-get install -y --no-install-recommends ${from}qgis python3-qgis qgis-providers"
  echo "apt-get install -y --no-install-recommends ${PACKAGES[*]}"
  # Debian would set up a database server that runs from then on
  local quiet=/etc/postgresql-common/createcluster.d
  echo "mkdir -p $quiet; echo 'create_main_cluster = false' > $quiet/lanewright.conf"
  echo "apt-get install -y --no-install-recommends ${TESTED_WITH[*]}"
  echo "rm $quiet/lanewright.conf"
}

candidate() { apt-cache policy qgis 2>/dev/null | sed -nE 's/^ +Candidate: ([0-9]+:)?([0-9]+\.[0-9]+).*/\2/p'; }

choose_release() {
  release="" add_backports=no mirror=http://deb.debian.org/debian
  local codename
  codename="$(. /etc/os-release && echo "${VERSION_CODENAME:-}")"
  if [ "$codename" = bookworm ]; then
    release=bookworm-backports
    mirror="$(apt-get indextargets --format '$(CODENAME) $(REPO_URI)' 2>/dev/null | awk '$1 == "bookworm" {print $2; exit}')"
    mirror="${mirror:-http://deb.debian.org/debian}"
    grep -rqs bookworm-backports /etc/apt/sources.list /etc/apt/sources.list.d || add_backports=yes
    return
  fi
  # An empty list says nothing yet: a fresh machine has never run apt-get update.
  local offered
  offered="$(candidate)"
  [ -n "$offered" ] || { as_root apt-get update -q >/dev/null 2>&1 || true; offered="$(candidate)"; }
  [ -z "$offered" ] || at_least "$offered" "$OLDEST" ||
    stop "This system offers QGIS $offered and Lanewright needs $OLDEST or newer: $NEWER."
}

installed="$(command -v qgis_process >/dev/null && qgis_version || true)"
if [ -n "$installed" ] && ! at_least "$installed" "$OLDEST"; then
  stop "QGIS $installed is installed and Lanewright needs $OLDEST or newer: $NEWER."
fi
if [ -z "$installed" ] || ! have_python_packages; then
  command -v apt-get >/dev/null ||
    stop "No apt-get here: install QGIS $OLDEST or newer and, for its Python, ${PACKAGES[*]#python3-}, then run this again."
  choose_release
  lines="$(install_script "$release")"
  as_root true || stop "$(printf 'Installing needs root and there is no sudo for you here. Run this as root, then start again:\n\n%s' "$lines")"
  echo "Installing QGIS and the Python packages (some minutes, about 2 GB)"
  as_root sh -c "$lines"
  source tools/env.sh # where PROJ's data lie is known now
  installed="$(qgis_version)"
  at_least "${installed:-0}" "$OLDEST" ||
    stop "QGIS ${installed:-none} was installed and Lanewright needs $OLDEST or newer: $NEWER."
fi

mkdir -p "$XDG_RUNTIME_DIR" "$QGIS_PLUGINPATH" "$QGIS_CUSTOM_CONFIG_PATH"
chmod 0700 "$XDG_RUNTIME_DIR"
# A checkout that was moved, or a new Python, leaves a virtual environment that points nowhere.
"$LANEWRIGHT_BUILD/venv/bin/python" -c "import sys; sys.exit(sys.prefix != '$LANEWRIGHT_BUILD/venv')" 2>/dev/null ||
  { rm -rf "$LANEWRIGHT_BUILD/venv"; "$PY" -m venv --system-site-packages "$LANEWRIGHT_BUILD/venv"; }
"$LANEWRIGHT_BUILD/venv/bin/python" -m pip install -qq --disable-pip-version-check --cache-dir "$LANEWRIGHT_BUILD/pip" --no-deps -r requirements-dev.txt
LANEWRIGHT_LIBS="$(echo "$LANEWRIGHT_BUILD"/venv/lib/python3*/site-packages)"
"$LANEWRIGHT_BUILD/venv/bin/python" -c 'import laspy, lazrs, pytest_qgis, pytest_timeout, shapely; assert shapely.geos_version' ||
  stop "The Python packages of requirements-dev.txt were installed but cannot be imported; the lines above say why."

ln -sfn "$LANEWRIGHT_ROOT" "$QGIS_PLUGINPATH/lanewright"
qgis_process plugins enable lanewright >"$LANEWRIGHT_BUILD/setup.log" 2>&1 || true
qgis_process list >>"$LANEWRIGHT_BUILD/setup.log" 2>&1
grep -q 'lanewright:' "$LANEWRIGHT_BUILD/setup.log" ||
  stop "QGIS started but does not list Lanewright's algorithms; $LANEWRIGHT_BUILD/setup.log holds what it said."
stamp_now >"$stamp"
echo "Lanewright is set up for QGIS $installed. Try: make demo"
