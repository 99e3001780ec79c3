#!/usr/bin/env bash
# Every scenario of the field, one after the other, in 43 minutes: a line each, and exit 1 if one of them failed.
# Root; a quiet machine, since agents run in real time. Options are those of field.sh (--program, ...).
#   deploy/netns/all.sh [OPTIONS]
set -uo pipefail
here=$(dirname "$0")
program=$here/../../build/release/bin/fleetmap
for ((i = 1; i < $#; ++i)); do [[ ${!i} != --program ]] || { next=$((i + 1)); program=${!next}; }; done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM
failed=0
field() {
  local code=0
  "$here/field.sh" "$@" 2> "$scratch/errors" || code=$?
  ((code == 0 || code == 77)) || grep -v Killed "$scratch/errors" >&2
  ((code != 77)) || exit 77
  ((code == 0)) || failed=$((failed + 1))
}

for agents in 3 4 6 10 20; do field --scenario discovery --agents "$agents" "$@"; done
for agents in 4 10; do field --scenario discovery --agents "$agents" --loss 20 "$@"; done
field --scenario discovery --loss 10 --delay 300 --jitter 100 --duplicate 5 "$@"
for agents in 4 10; do field --scenario restart --agents "$agents" "$@"; done
for scenario in idle one_way absent_interface address_gone two_fleets twins check; do field --scenario "$scenario" "$@"; done
for kbit in 15000 4000 2000; do field --scenario contact --wifi "$kbit" "$@"; done

"$program" run -c "$here/../../config/fleets/farm_small.yaml" --agents 4 --record "$scratch/recordings" --out "$scratch/run" > "$scratch/run.log" 2>&1 ||
  { tail -n 5 "$scratch/run.log" >&2; exit 2; }
for scenario in multicast map apart radio_down kill kill_all new_disk late lidar_clock; do
  field --scenario "$scenario" --recordings "$scratch/recordings" "$@"
done
echo "$failed scenarios failed"
((failed == 0))
