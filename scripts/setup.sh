#!/usr/bin/env bash
# setup.sh: install what a bare Debian 12 needs to build and test Kinetome. Does nothing when all is there.
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache
  libeigen3-dev libhdf5-dev hdf5-filter-plugin-blosc-serial libtbb-dev
  libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libspdlog-dev libfmt-dev libxxhash-dev
  libflann-dev liblz4-dev libnanoflann-dev
  libopenmpi-dev openmpi-bin
  catch2 clang-format
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || {
    echo "setup.sh: run as root, or install by hand: apt-get install ${missing[*]}" >&2
    exit 73
  }
  as_root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}" >&2
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends "${missing[@]}"
