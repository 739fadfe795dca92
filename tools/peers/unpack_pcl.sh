#!/usr/bin/env bash
# Debian's PCL into build/peers/debian, without installing it: on Debian 12, libpcl-dev and QGIS from
# bookworm-backports want different versions of other libraries, and apt cannot have both.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../env.sh"
place="$LANEWRIGHT_BUILD/peers/debian"
version="$(apt-cache depends libpcl-dev | sed -nE 's/^ +Depends: libpcl-common([0-9.]+)$/\1/p')"
[ -n "$version" ] || { echo "apt knows no libpcl-dev; run apt-get update first." >&2; exit 2; }
packages=(libpcl-dev libeigen3-dev libflann-dev libflann1.9 liblz4-dev)
for part in common filters segmentation kdtree octree search sample-consensus features ml; do
  packages+=("libpcl-$part$version")
done
rm -rf "$place" && mkdir -p "$place/packages"
(cd "$place/packages" && apt-get download -q -o APT::Sandbox::User=root "${packages[@]}")
for package in "$place"/packages/*.deb; do dpkg-deb -x "$package" "$place"; done
rm -r "$place/packages"
echo "$place"
