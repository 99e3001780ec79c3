#!/usr/bin/env bash
# Runs clang-tidy (.clang-tidy names the checks) and fails on any finding.
#   deploy/tidy.sh              .cpp files touched by the last 20 commits, latest first, as many as are begun within TIDY_SECONDS (120)
#   deploy/tidy.sh COMMIT       all .cpp files that differ from COMMIT, committed or not
#   deploy/tidy.sh all          all .cpp files
#   deploy/tidy.sh FILE.cpp...  these
set -euo pipefail
cd "$(dirname "$0")/.."

git_() { git -c safe.directory='*' "$@"; }
seconds=999999
case "${1:-}" in
  "") seconds=${TIDY_SECONDS:-120}
      files=$(git_ log -n 20 --format= --name-only -- '*.cpp') ;;
  all) files=$(git_ ls-files 'src/*.cpp' 'tests/*.cpp') ;;
  *.cpp) files=$(printf '%s\n' "$@") ;;
  *) files=$(git_ diff --name-only "$1" -- '*.cpp') ;;
esac
# Sources before tests: these take three times as long and hold less.
present=$(awk 'NF && !seen[$0]++' <<<"$files" | while read -r file; do [ ! -f "$file" ] || echo "$file"; done)
files=$(grep -v '^tests/' <<<"$present" || true; grep '^tests/' <<<"$present" || true)
[ -n "$files" ] || { echo "clang-tidy: no file to check"; exit 0; }

log=$(mktemp)
trap 'rm -f "$log"' EXIT
{ cmake --preset release && cmake --build --preset release --target fleetmap_idl_generate; } >"$log" 2>&1 || { cat "$log"; exit 1; }
# clang can read neither GCC's precompiled headers nor all of its flags.
mkdir -p build/tidy
sed -E 's/ -Winvalid-pch -include [^ ]*cmake_pch\.hxx//; s/ -Werror / /' build/release/compile_commands.json >build/tidy/compile_commands.json

export deadline=$(($(date +%s) + seconds))
check() {
  if [ "$(date +%s)" -ge "$deadline" ]; then
    echo "not checked for want of time: $1"
    return
  fi
  local findings status=0
  findings=$(clang-tidy --quiet -p build/tidy "$1" 2>&1) || status=$?
  [ "$status" -eq 0 ] || { echo "$findings"; return 1; }
}
export -f check
xargs -P "$(nproc)" -I{} bash -c 'check "$1"' _ {} <<<"$files" >"$log" || { grep -v "^not checked\|warnings generated" "$log"; exit 1; }
left=$(grep -c '^not checked' "$log" || true)
echo "clang-tidy: no findings in $(($(wc -l <<<"$files") - left)) files, $left left for want of time (deploy/tidy.sh all)"
