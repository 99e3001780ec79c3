#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test through ctest: first what needs the program as it is shipped
# (release build: fleets, and the drives whose accuracy is measured), then the unit tests under AddressSanitizer and
# UndefinedBehaviorSanitizer, then those of core, bus and monitor, where threads meet, under ThreadSanitizer.
#   deploy/test.sh            all of these
#   deploy/test.sh release    all tests and benchmarks in the release build; shipped, asan or tsan: one of the three parts
set -euo pipefail
cd "$(dirname "$0")/.."

./deploy/install-dependencies.sh --browser
presets=("$@")
[ "${#presets[@]}" -gt 0 ] || presets=(shipped asan tsan)

# Debian 12's ThreadSanitizer cannot run where the kernel places memory more randomly than it expects.
with_addresses_for() {
  local preset=$1
  shift
  if [ "$preset" = tsan ] && setarch -R true 2>/dev/null; then setarch -R "$@"; else "$@"; fi
}

build() {
  local preset=$1
  cmake --preset "${preset/shipped/release}" -DFLEETMAP_UNITY=ON >/dev/null  # shipped: its program, fewer of its targets
  with_addresses_for "$preset" cmake --build --preset "$preset"  # which also runs test programs, to list their tests
}

echo "== ${presets[0]}: build"
build "${presets[0]}"
# Many tests of the shipped program wait for each other, so the rest is built on processors that are idle.
log=$(mktemp)
setsid nice -n 15 bash -c "set -euo pipefail; $(declare -f with_addresses_for build)
  for preset; do echo \"== \$preset: build\"; build \"\$preset\"; done" build "${presets[@]:1}" >"$log" 2>&1 &
others=$!
trap 'kill -- "-$others" 2>/dev/null || true; rm -f "$log"' EXIT

echo "== ${presets[0]}: test"
with_addresses_for "${presets[0]}" ctest --preset "${presets[0]}" -j "$(nproc)"
wait "$others" || { cat "$log"; exit 1; }
cat "$log"
for preset in "${presets[@]:1}"; do
  echo "== $preset: test"
  with_addresses_for "$preset" ctest --preset "$preset" -j "$(nproc)"
done
