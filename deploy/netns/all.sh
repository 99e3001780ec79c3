#!/usr/bin/env bash
# Every scenario of the field, in half an hour: a line each as it ends, and exit 1 if one of them failed.
# Root; a quiet machine, since agents run in real time. Each scenario has namespaces of its own, so several run at once: two
# for each core, since four agents that map take a quarter of one, and three where nothing is mapped.
#   deploy/netns/all.sh [--jobs CORES] [OPTIONS of field.sh: --program FILE, ...]
set -uo pipefail
here=$(dirname "$0")
program=$here/../../build/release/bin/fleetmap
cores=$(nproc)
options=()
while (($#)); do
  case $1 in
    --jobs) cores=$2; shift ;;
    --program) program=$2; options+=("$1" "$2"); shift ;;
    *) options+=("$1") ;;
  esac
  shift
done
scratch=$(mktemp -d)
declare -A running=() # what each process writes to
begun=0 failed=0 skipped=0
trap 'kill "${!running[@]}" 2> /dev/null; wait; rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM

one_ends() {
  local pid code=0
  wait -n -p pid || code=$?
  local file=${running[$pid]}
  unset "running[$pid]"
  cat "$file"
  case $code in
    0) ;;
    77) skipped=$((skipped + 1)) ;;
    *) failed=$((failed + 1)) && grep -v Killed "$file.errors" >&2 ;;
  esac
}
# Begins a scenario as soon as fewer than $room run.
room=1
field() {
  while ((${#running[@]} >= room)); do one_ends; done
  local file=$scratch/$((++begun))
  "$here/field.sh" "$@" "${options[@]}" > "$file" 2> "$file.errors" &
  running[$!]=$file
}
field_with_maps() { field --recordings "$scratch/recordings" "$@"; }

"$program" run -c "$here/../../config/fleets/farm_small.yaml" --agents 4 --record "$scratch/recordings" --record-format sqlite3 --out "$scratch/run" > "$scratch/run.log" 2>&1 ||
  { tail -n 5 "$scratch/run.log" >&2; exit 2; }
room=$((2 * cores))
for scenario in late new_disk kill_all apart kill radio_down multicast lidar_clock map full_disk damage clock_back \
  other_address sigterm three_machines; do
  field_with_maps --scenario "$scenario"
done
for impairment in "--loss 10" "--loss 20" "--delay 300"; do
  # shellcheck disable=SC2086
  field_with_maps --scenario apart --patience 900 $impairment
done
for kbit in 2000 4000; do field_with_maps --scenario map --agents 3 --wifi "$kbit" --patience 900; done
for kbit in 2000 4000 15000; do field --scenario contact --wifi "$kbit"; done
field --scenario fair --wifi 4000
room=$((3 * cores))
for scenario in address_gone idle two_fleets one_way absent_interface check twins no_address; do field --scenario "$scenario"; done
for agents in 3 4 6 10; do field --scenario restart --agents "$agents"; done
for agents in 3 6; do field --scenario restart --agents "$agents" --loss 20; done
for agents in 3 4 6 10; do field --scenario discovery --agents "$agents"; done
for agents in 4 10; do field --scenario discovery --agents "$agents" --loss 20; done
field --scenario discovery --loss 10 --delay 300 --jitter 100 --duplicate 5
field --scenario discovery --agents 6 --radio 50 --set long_range.budget_kbit_s=36
room=1  # twenty agents keep two cores busy when they start, and ten when they map
field --scenario discovery --agents 20
field --scenario half_off --agents 20 --loss 20
field --scenario discovery --agents 20 --loss 20
field --scenario restart --agents 20
field --scenario restart --agents 20 --loss 20
field --scenario map --agents 10 --patience 900
while ((${#running[@]})); do one_ends; done
((skipped == 0)) || exit 77
echo "$failed of $begun scenarios failed"
((failed == 0))
