#!/bin/sh
# Installs what spume is built from on Debian 12, as root or with sudo. Does nothing, and touches no network, when
# everything is there.
set -eu

packages="g++ cmake ninja-build
libopenvdb-dev libboost-iostreams-dev libeigen3-dev libcgal-dev libsuitesparse-dev libtbb-dev
libcli11-dev libtomlplusplus-dev libembree-dev libpng-dev libgtest-dev"

missing=
for package in $packages; do
  dpkg -s "$package" 2>/dev/null | grep -q '^Status: install ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "These packages are missing, and installing them takes root or sudo:$missing" >&2
    exit 1
  fi
  as_root=sudo
fi
echo "Installing:$missing"
$as_root apt-get update -q
# shellcheck disable=SC2086  # a list of words
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
