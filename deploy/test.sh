#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test through ctest: first what needs the program as it is shipped
# (release build: fleets, and the drives whose accuracy is measured), then the unit tests under AddressSanitizer and
# UndefinedBehaviorSanitizer, then those of core, bus, monitor and agent, where threads meet, under ThreadSanitizer.
#   deploy/test.sh            all of these
#   deploy/test.sh release    all tests and benchmarks in the release build; shipped, asan or tsan: one of the three parts
set -euo pipefail
cd "$(dirname "$0")/.."

./deploy/install-dependencies.sh --browser
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(shipped asan tsan)
for preset in "${presets[@]}"; do
  echo "== $preset: configure, build, test"
  configuration=${preset/shipped/release}  # its program, fewer of its targets
  log=$(mktemp)
  cmake --preset "$configuration" >"$log" 2>&1 || { cat "$log"; exit 1; }
  rm -f "$log"
  # Debian 12's ThreadSanitizer cannot run where the kernel places memory more randomly than it expects.
  fixed_addresses=()
  [ "$preset" != tsan ] || ! setarch -R true 2>/dev/null || fixed_addresses=(setarch -R)
  "${fixed_addresses[@]}" cmake --build --preset "$preset"  # which also runs test programs, to list their tests
  "${fixed_addresses[@]}" ctest --preset "$preset" -j "$(nproc)"
done
