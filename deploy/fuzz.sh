#!/usr/bin/env bash
# Builds the fuzz targets of tests/fuzz (clang, libFuzzer, address and undefined sanitizers) and runs each alone.
#   deploy/fuzz.sh                        60 seconds each
#   deploy/fuzz.sh 600 geojson pcd        10 minutes each of these
# Inputs that reach other code are kept, minimised, in build/fuzz/corpus; small ones of them are added to
# tests/fuzz/corpus, which CI replays, as long as a target's folder stays below 12 kB and 24 files. An input that fails
# is put into build/fuzz/findings: correct the reader, then copy the input to tests/fuzz/corpus/TARGET under a name that
# says what it found.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
shift || true
targets=("$@")
if [ "${#targets[@]}" -eq 0 ]; then
  mapfile -t targets < <(sed -n 's/^fuzz_target(\([a-z_0-9]*\) .*/\1/p' tests/fuzz/CMakeLists.txt)
fi

log=$(mktemp)
# Readers that take a path get their bytes in a file, which should cost no disk.
export TMPDIR
TMPDIR=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo /tmp)" fleetmap_fuzz_XXXXXX)
trap 'rm -rf "$log" "$TMPDIR"' EXIT
{ cmake --preset fuzz && cmake --build build/fuzz -j "${FUZZ_JOBS:-$(nproc)}" --target "${targets[@]/#/fuzz_}"; } \
  >"$log" 2>&1 || { tail -n 60 "$log"; exit 1; }

# Fast DDS deletes an object through a base without a virtual destructor; the programs of tests allow it as well.
export ASAN_OPTIONS=new_delete_type_mismatch=0:detect_leaks=${FUZZ_LEAKS:-1}:${ASAN_OPTIONS:-}

max_bytes=12288 max_files=24
# Adds inputs of folder $1, of small to medium size, to folder $2 until it is full.
keep_some() {
  local bytes files size file
  bytes=$(cat "$2"/* 2>/dev/null | wc -c)
  files=$(find "$2" -type f | wc -l)
  while read -r size file; do
    [ ! -e "$2/$(basename "$file")" ] || continue
    [ $((bytes + size)) -le "$max_bytes" ] && [ "$files" -lt "$max_files" ] || break
    cp "$file" "$2/"
    bytes=$((bytes + size)) files=$((files + 1))
  done < <(find "$1" -type f -size -2k -printf '%s %p\n' | sort -n |
             awk -v max="$max_files" '{line[NR] = $0} END {for (k = 1; k <= NR; k += 1 + int(NR / max)) print line[k]}')
}

failed=()
for target in "${targets[@]}"; do
  program=build/fuzz/bin/fuzz_$target committed=tests/fuzz/corpus/$target
  corpus=build/fuzz/corpus/$target findings=build/fuzz/findings/$target
  mkdir -p "$committed" "$corpus" "$findings"
  output=build/fuzz/$target.log
  status=0
  "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len="${FUZZ_MAX_LEN:-12288}" \
    -print_final_stats=1 -artifact_prefix="$findings/" "$corpus" "$committed" 2>"$output" >/dev/null || status=$?
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$output")
  covered=$(grep -ao 'cov: [0-9]*' "$output" | tail -n 1 || true)
  echo "$target: ${executed:-?} executions, $covered edges$([ "$status" -eq 0 ] || echo ", FAILED: see $output")"
  if [ "$status" -ne 0 ]; then
    failed+=("$target")
    continue
  fi
  rm -rf "$corpus.merged" && mkdir "$corpus.merged"
  "$program" -merge=1 -timeout=10 "$corpus.merged" "$committed" "$corpus" 2>>"$output" >/dev/null || continue
  rm -rf "$corpus" && mv "$corpus.merged" "$corpus"
  keep_some "$corpus" "$committed"
done
[ "${#failed[@]}" -eq 0 ] || { echo "inputs that fail are in build/fuzz/findings: ${failed[*]}" >&2; exit 1; }
