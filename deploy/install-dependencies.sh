#!/usr/bin/env bash
# Installs with apt what is missing to build and test fleetmap on Debian 12. Needs root, directly or through sudo.
#   deploy/install-dependencies.sh --browser    also Chromium, in which the monitor's page is tested
#   deploy/install-dependencies.sh --arm64      also what deploy/package_arm64.sh needs
set -euo pipefail

packages=(
  build-essential clang libclang-rt-14-dev cmake ninja-build ccache clang-format clang-tidy default-jre-headless
  fastddsgen libfastrtps-dev libfastcdr-dev libtinyxml2-dev
  libeigen3-dev libpcl-dev libnanoflann-dev libdraco-dev libgeographiclib-dev libsleef-dev
  libyaml-cpp-dev libcli11-dev libspdlog-dev libexpected-dev nlohmann-json3-dev
  libsqlite3-dev libssl-dev liblzma-dev libzstd-dev liblz4-dev libbz2-dev zlib1g-dev libembree-dev libpng-dev libgdal-dev libboost-dev libsystemd-dev
  libgtest-dev libgmock-dev libbenchmark-dev cyclonedds-dev cyclonedds-tools gdal-bin
  iproute2 procps python3
)

# The page of `fleetmap monitor` is bundled with npm; one that did not come from Debian serves as well.
command -v npm >/dev/null || packages+=(npm)

[ "${1:-}" != --arm64 ] || packages+=(g++-aarch64-linux-gnu qemu-user-static)

missing=()
want() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'install ok installed' || missing+=("$1"); }
for package in "${packages[@]}"; do want "$package"; done
needed=("${missing[@]}")
[ "${1:-}" != --browser ] || want chromium
[ "${#missing[@]}" -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install these as root first: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing: ${missing[*]}"
install() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}
"${as_root[@]}" apt-get update -qq
[ "${#needed[@]}" -eq 0 ] || install "${needed[@]}"
if [ "${#needed[@]}" -lt "${#missing[@]}" ]; then
  install chromium || echo "Chromium could not be installed: the test of the monitor's page will be skipped" >&2
fi
