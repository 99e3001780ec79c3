#!/usr/bin/env bash
# Whether a 64-bit ARM places a fleet at the same bits as this processor: builds tests/bench/placement_bits.cpp with the
# pure libraries (core, geometry, graph) for both, and runs the ARM program under QEMU.
#   deploy/arm_bits.sh     needs g++-aarch64-linux-gnu, qemu-user and, in ARM_ROOT (default /), libgeographiclib-dev:arm64,
#                          libsleef-dev:arm64 and libssl-dev:arm64 (apt-get download, dpkg -x)
set -euo pipefail
cd "$(dirname "$0")/.."
out=build/arm_bits
mkdir -p "$out"
sources=(tests/bench/placement_bits.cpp tests/graph/simulated_fleet.cpp tests/graph/simulated_filter.cpp
         src/core/ids.cpp src/core/bytes.cpp src/geometry/*.cpp src/graph/*.cpp src/graph/*/*.cpp)
flags=(-std=c++20 -O3 -DNDEBUG -ffp-contract=off -U__ARM_FEATURE_FMA -Iinclude -Itests -Isrc/graph -isystem /usr/include/eigen3)
build() { # COMPILER NAME MULTIARCH LINKER-FLAGS...
  local compiler=$1 name=$2 headers=${ARM_ROOT:-}/usr/include/$3 source object objects=()
  shift 3
  for source in "${sources[@]}"; do
    object=$out/$name.$(tr / . <<<"$source").o
    [[ $object -nt $source && -z $(find include src tests -name '*.hpp' -newer "$object" -print -quit) ]] || "$compiler" "${flags[@]}" -idirafter "$headers" -c "$source" -o "$object"
    objects+=("$object")
  done
  "$compiler" "${objects[@]}" "$@" -o "$out/placement_bits_$name"
}
build g++ x86 x86_64-linux-gnu -lGeographicLib -lsleef -lcrypto
build aarch64-linux-gnu-g++ arm aarch64-linux-gnu -L"${ARM_ROOT:-}/usr/lib/aarch64-linux-gnu" -lGeographicLib -lsleef \
  -lcrypto

"$out/placement_bits_x86" make "$out/fleet"
here=$("$out/placement_bits_x86" place "$out/fleet")
arm=$(QEMU_LD_PREFIX=/usr/aarch64-linux-gnu LD_LIBRARY_PATH="${ARM_ROOT:-}/usr/lib/aarch64-linux-gnu" \
      qemu-aarch64 -E LD_LIBRARY_PATH="${ARM_ROOT:-}/usr/lib/aarch64-linux-gnu:/usr/aarch64-linux-gnu/lib" \
      "$out/placement_bits_arm" place "$out/fleet")
printf 'here: %s\nARM:  %s\n' "$here" "$arm"
[ "$here" = "$arm" ] || { echo "the bits differ"; exit 1; }
