#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test through ctest, each once: first what needs the program as it is
# shipped (release build: fleets, and the drives whose accuracy is measured), then the unit tests under AddressSanitizer
# and UndefinedBehaviorSanitizer.
#   deploy/test.sh            all tests
#   deploy/test.sh release    all tests and benchmarks in the release build; asan and tsan: the unit tests under these
set -euo pipefail
cd "$(dirname "$0")/.."

./deploy/install-dependencies.sh
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(shipped asan)
for preset in "${presets[@]}"; do
  echo "== $preset: configure, build, test"
  configuration=${preset/shipped/release}  # its program, fewer of its targets
  log=$(mktemp)
  cmake --preset "$configuration" >"$log" 2>&1 || { cat "$log"; exit 1; }
  rm -f "$log"
  cmake --build --preset "$preset"
  ctest --preset "$preset" -j "$(nproc)"
done
