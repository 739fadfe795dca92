#!/usr/bin/env bash
# The tests on the newest QGIS that Debian has (3.44 in forky), in a system of its own under build/: nothing of
# this machine is changed. Needs root and debootstrap; arguments go to tools/test.sh.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
release="${LANEWRIGHT_RELEASE:-forky}"
system="$LANEWRIGHT_BUILD/$release"
mirror="${LANEWRIGHT_MIRROR:-http://deb.debian.org/debian}"
[ "$(id -u)" -eq 0 ] || { echo "A Debian of its own needs root: run this with sudo." >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "Install debootstrap first: apt install debootstrap" >&2; exit 2; }

if [ ! -e "$system/.made" ]; then
  script=/usr/share/debootstrap/scripts/$release
  [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid # an older debootstrap does not know the name
  rm -rf "$system"
  debootstrap --variant=minbase --include=ca-certificates,make,git "$release" "$system" "$mirror" "$script"
  touch "$system/.made"
fi

clean_up() {
  umount -l "$system/proc" "$system/dev" 2>/dev/null || true
}
trap clean_up EXIT
mountpoint -q "$system/proc" || mount -t proc proc "$system/proc"
mountpoint -q "$system/dev" || mount --bind /dev "$system/dev"
cp -L /etc/resolv.conf "$system/etc/resolv.conf"
# What this machine trusts and where its pip looks
cp -L /etc/ssl/certs/ca-certificates.crt "$system/root/ca.crt"
for file in /etc/pip.conf; do [ -e "$file" ] && sed 's#^cert *=.*#cert = /root/ca.crt#' "$file" >"$system$file"; done

# Mirrors of a release in the making lag behind
echo 'Acquire::Check-Valid-Until "false";' >"$system/etc/apt/apt.conf.d/99lagging"

# This checkout's files, with the build folder of the last time kept
mkdir -p "$system/lanewright"
find "$system/lanewright" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
git ls-files -z | tar -c --null -T - | tar -x -C "$system/lanewright"
run() { chroot "$system" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 PIP_CERT=/root/ca.crt SSL_CERT_FILE=/root/ca.crt "$@"; }
run make -C /lanewright setup
run qgis_process --version | head -n 1
run /lanewright/tools/test.sh "$@"
