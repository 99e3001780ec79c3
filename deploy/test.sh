#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test through ctest: first the release build with the integration
# tests, then the unit tests again under AddressSanitizer and UndefinedBehaviorSanitizer (without the long drives that
# measure accuracy: shorter ones go through the same code).
#   deploy/test.sh            all of it
#   deploy/test.sh release    one build only (release, asan or tsan)
set -euo pipefail
cd "$(dirname "$0")/.."

./deploy/install-dependencies.sh
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(release asan)
for preset in "${presets[@]}"; do
  echo "== $preset: configure, build, test"
  cmake --preset "$preset" >"/tmp/fleetmap-configure-$preset.$$" 2>&1 || { cat "/tmp/fleetmap-configure-$preset.$$"; exit 1; }
  rm -f "/tmp/fleetmap-configure-$preset.$$"
  cmake --build --preset "$preset"
  ctest --preset "$preset" -j "$(nproc)"
done
