#!/usr/bin/env bash
# Agents as processes, each in a network namespace, around one radio and one Wi-Fi that they share. Root; needs iproute2,
# python3 and a built program. Namespaces are its own and go when it ends, also when it is interrupted.
#   deploy/netns/field.sh --scenario NAME [--agents N] [--radio KBIT] [--wifi KBIT] [--program FILE] [--out DIR]
#                         [--loss PERCENT] [--delay MS] [--jitter MS] [--duplicate PERCENT]   of the radio's datagrams
#                         [--wifi-loss PERCENT] [--wifi-delay MS] [--wifi-jitter MS]          of the Wi-Fi's
#                         [--wifi-from S] [--patience S] [--seed N]   of scenario trial, after the recordings began
#                         [--trace FILE] [--trace-from S]   what each pair of robots had in the field (link_trace.py)
#                         [--qos DIR] [--robot FILE] [--set KEY=VALUE]...   of the agents: profiles; sensors and all else
#                                              of this agent's file; single keys
#                         [--keys]   the agents are members of a fleet with keys
#                         [--rate N]           recordings are replayed at N times real time
#                         [--recordings DIR]   DIR/r1, DIR/r2, ...: what `fleetmap run -c FLEET.yaml --record DIR` leaves;
#                                              those of a small farm are made where it is not given
#   deploy/netns/field.sh --list
# Prints a line a scenario and exits with 1 if what the scenario asserts does not hold, with 77 where namespaces are not
# allowed. Bytes are those of the interface behind the queue that all share, not our own counters.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$root/deploy/netns/medium.sh"
. "$root/deploy/netns/field_robots.sh"
. "$root/deploy/netns/discovery_scenarios.sh"
. "$root/deploy/netns/mapping_scenarios.sh"
. "$root/deploy/netns/fault_scenarios.sh"

agents=4
scenario=
radio=200
wifi=15000
program=$root/build/release/bin/fleetmap
out=
recordings=
impairment=()
wifi_impairment=()
trace=
trace_from=0
qos=$root/qos
robot=
settings=()
patience=420
seed=1
wifi_from=0
keys=
rate=1
environment=()
MOUNTS=()
usage() { sed -n '2,18s/^# \{0,1\}//p' "$0" >&2; exit 2; }
while (($#)); do
  [[ $1 != --list ]] || { list_scenarios; exit 0; }
  [[ $1 != --keys ]] || { keys=yes; shift; continue; }
  (($# > 1)) || usage
  case $1 in
    --agents) agents=$2 ;;
    --scenario) scenario=$2 ;;
    --radio) radio=$2 ;;
    --wifi) wifi=$2 ;;
    --recordings) recordings=$2 ;;
    --program) program=$2 ;;
    --out) out=$2 ;;
    --loss | --delay | --jitter | --duplicate) impairment+=("$1" "$2") ;;
    --wifi-loss | --wifi-delay | --wifi-jitter | --wifi-duplicate) wifi_impairment+=("--${1#--wifi-}" "$2") ;;
    --trace) trace=$2 ;;
    --trace-from) trace_from=$2 ;;
    --qos) qos=$2 ;;
    --robot) robot=$2 ;;
    --set) settings+=(--set "$2") ;;
    --patience) patience=$2 ;;
    --seed) seed=$2 ;;
    --wifi-from) wifi_from=$2 ;;
    --rate) rate=$2 ;;
    *) usage ;;
  esac
  shift 2
done
declare -F "scenario_$scenario" > /dev/null || { echo "no scenario '$scenario'; there are:" >&2; list_scenarios >&2; exit 2; }
[[ -x $program ]] || { echo "$program: is no program; build it, or name it with --program" >&2; exit 2; }
for tool in ip tc sysctl python3; do
  command -v "$tool" > /dev/null || { echo "skipped: needs $tool (deploy/install-dependencies.sh)"; exit 77; }
done
[[ $(id -u) == 0 ]] && ip netns add "$FIELD-try" 2>/dev/null ||
  { echo "skipped: needs root and network namespaces"; exit 77; }
ip netns del "$FIELD-try"

scratch=$(mktemp -d)
out=${out:-$scratch/out}
[[ ! -e $out/r1.log ]] || { echo "--out $out: holds an earlier run" >&2; exit 2; }
mkdir -p "$out"
finish() {
  local mounted
  remove_spaces
  for mounted in "${MOUNTS[@]}"; do umount "$mounted"; done
  rm -rf "$scratch"
}
trap finish EXIT
trap 'exit 130' INT TERM

for ((i = 1; i <= agents; ++i)); do make_space "robot$i"; done
medium radio 77 "$radio" 30000 "$agents"
medium wifi 78 "$wifi" 100000 "$agents"
if [[ -n $trace ]]; then
  impairment+=(--trace "$trace" --trace-from "$trace_from" --link long_range --names "$(addresses 77)")
  wifi_impairment+=(--trace "$trace" --trace-from "$trace_from" --link short_range --names "$(addresses 78)")
fi
((${#impairment[@]} == 0)) || relay radio "${impairment[@]}"
((${#wifi_impairment[@]} == 0)) || relay wifi "${wifi_impairment[@]}"
[[ -z $keys ]] || make_keys
for ((i = 1; i <= agents; ++i)); do write_config $i "r$i" "$(names)"; done
"scenario_$scenario"
