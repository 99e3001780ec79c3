#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy names the checks) and fails on any finding.
#   deploy/tidy.sh              the 16 .cpp files that were touched last (TIDY_FILES=N: N of them), sources before tests
#   deploy/tidy.sh COMMIT       all .cpp files that differ from COMMIT, committed or not
#   deploy/tidy.sh all          all .cpp files
#   deploy/tidy.sh FILE.cpp...  these
set -euo pipefail
cd "$(dirname "$0")/.."

git_() { git -c safe.directory='*' "$@"; }
apart=(':!tests/bench/peers' ':!deploy/package/example')  # need what is not here, or is installed
most=999999
case "${1:-}" in
  "") most=${TIDY_FILES:-16}
      files=$(git_ log -n 60 --format= --name-only -- '*.cpp' "${apart[@]}") ;;
  all) files=$(git_ ls-files 'src/*.cpp' 'tests/*.cpp' "${apart[@]}") ;;
  *.cpp) files=$(printf '%s\n' "$@") ;;
  *) files=$(git_ diff --name-only "$1" -- '*.cpp' "${apart[@]}") ;;
esac
# Sources before tests: these take three times as long and hold less.
present=$(awk 'NF && !seen[$0]++' <<<"$files" | while read -r file; do [ ! -f "$file" ] || echo "$file"; done)
files=$( (grep -v '^tests/' <<<"$present" || true; grep '^tests/' <<<"$present" || true) | awk -v most="$most" 'NR <= most')
[ -n "$files" ] || { echo "clang-tidy: no file to check"; exit 0; }

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# In a unity build the files that clang-tidy is asked about have no command of their own.
{ cmake --preset release -DFLEETMAP_UNITY=OFF && cmake --build --preset release --target fleetmap_idl_generate fleetmap_version; } >"$log" 2>&1 || { cat "$log"; exit 1; }
# clang can read neither GCC's precompiled headers nor all of its flags.
mkdir -p build/tidy
sed -E 's/ -Winvalid-pch -include [^ ]*cmake_pch\.hxx//; s/ -Werror / /' build/release/compile_commands.json >build/tidy/compile_commands.json

check() {
  local findings status=0
  findings=$(clang-tidy --quiet -p build/tidy "$1" 2>&1) || status=$?
  [ "$status" -eq 0 ] || { echo "$findings"; return 1; }
}
export -f check
xargs -P "$(nproc)" -I{} bash -c 'check "$1"' _ {} <<<"$files" >"$log" || { cat "$log"; exit 1; }
echo "clang-tidy: no findings in $(wc -l <<<"$files") files"
