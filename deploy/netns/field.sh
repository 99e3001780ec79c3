#!/usr/bin/env bash
# Agents as processes, each in a network namespace, around one radio and one Wi-Fi that they share. Root; needs iproute2
# and a built program. Namespaces are its own and go when it ends, also when it is interrupted.
#   deploy/netns/field.sh --agents N --scenario NAME [--radio KBIT] [--wifi KBIT] [--program FILE] [--out DIR]
#                         [--recordings DIR]   DIR/r1, DIR/r2, ...: what `fleetmap run -c FLEET.yaml --record DIR` leaves
# Prints a line a scenario and exits with 1 if what the scenario asserts does not hold. Bytes are those of the interface
# behind the queue that all share, not our own counters.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$root/deploy/netns/medium.sh"

agents=4
scenario=discovery
radio=200
wifi=15000
program=$root/build/release/bin/fleetmap
out=
recordings=
usage() { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
while (($#)); do
  (($# > 1)) || usage
  case $1 in
    --agents) agents=$2 ;;
    --scenario) scenario=$2 ;;
    --radio) radio=$2 ;;
    --wifi) wifi=$2 ;;
    --recordings) recordings=$2 ;;
    --program) program=$2 ;;
    --out) out=$2 ;;
    *) usage ;;
  esac
  shift 2
done
[[ -x $program ]] || { echo "$program: is no program; build it, or name it with --program" >&2; exit 2; }
[[ $(id -u) == 0 ]] || { echo "needs root for network namespaces" >&2; exit 2; }

scratch=$(mktemp -d)
out=${out:-$scratch/out}
mkdir -p "$out"
finish() { remove_spaces; rm -rf "$scratch"; }
trap finish EXIT
trap 'exit 130' INT TERM

names() { local i; for ((i = 1; i <= agents; ++i)); do echo -n "${i:+$([[ $i == 1 ]] || echo ', ')}r$i"; done; }
others() { # net, own number: addresses of the other robots
  local i list=
  for ((i = 1; i <= agents; ++i)); do ((i == $2)) || list+="${list:+, }10.$1.$i.2"; done
  echo "$list"
}
write_configs() {
  local i
  for ((i = 1; i <= agents; ++i)); do
    cat > "$scratch/r$i.yaml" <<YAML
id: r$i
fleet: [$(names)]
directory: $out/r$i
site: {origin: [39.0, -3.0, 600.0]}
lidar: {model: vlp16, translation: [0.0, 0.0, 0.6], max_range: 40.0, min_range: 0.6}
imu: {translation: [0.0, 0.0, 0.1]}
gps: {translation: [-0.2, 0.0, 0.5]}
nodes: {spacing: 4.0}
dds:
  qos: $root/qos
  onboard: {domain: $((10 + i)), shared_memory: false}
  long_range: {domain: 1, address: 10.77.$i.2, peers: [$(others 77 $i)]}
  short_range: {domain: 2, address: 10.78.$i.2, peers: [$(others 78 $i)]}
YAML
  done
}

start() { # robot number
  in_space "robot$1" "$program" agent -c "$scratch/r$1.yaml" --exit-after-idle "${idle:-0}" >> "$out/r$1.log" 2>&1 &
  disown $!
}
# How many others each of the robots has heard on the radio since its log was begun anew.
heard() { grep -c 'long_range: heard' "$out/r$1.log" 2>/dev/null || true; }
all_heard() {
  local i
  for ((i = 1; i <= agents; ++i)); do (($(heard $i) >= agents - 1)) || return 1; done
}
now() { date +%s%N; }

# Samples the radio each second into $series and $worst (kbit/s) while it waits for `$1` at most `$2` s.
watch_radio() { # condition, seconds
  local begin last second bytes kbit
  begin=$(now) second=$begin last=$(passed radio)
  worst=0 waited= series=
  while :; do
    sleep 0.1
    if [[ -z $waited ]] && $1; then waited=$((($(now) - begin) / 1000000)); fi
    if (($(now) - second >= 1000000000)); then
      bytes=$(passed radio)
      kbit=$(((bytes - last) * 8000000 / ($(now) - second)))
      worst=$((kbit > worst ? kbit : worst))
      series+=" $kbit"
      last=$bytes second=$(now)
    fi
    (($(now) - begin < $2 * 1000000000)) && [[ -z $waited || $scenario != map ]] || return 0
  done
}
never() { false; }
seconds_of() { [[ -n $1 ]] && echo "$(($1 / 1000)).$(($1 / 100 % 10)) s" || echo "not in time"; }
verdict() { # holds (0 or 1), text
  echo "$scenario, $agents robots, $radio kbit/s: $2: $(((!$1)) && echo FAILED || echo ok)"
  echo "  kbit/s, second by second:$series" >> "$out/series.txt"
  (($1))
}

all_start() { local i; for ((i = 1; i <= agents; ++i)); do start $i; done; }

scenario_discovery() { # all start at once, no sensors
  local before
  before=$(passed radio)
  all_start
  watch_radio all_heard 20
  verdict $([[ -n $waited ]] && ((waited < 10000 && worst <= 160)) && echo 1 || echo 0) \
    "all know all after $(seconds_of "$waited"); $((($(passed radio) - before) / 1000)) kB in 20 s, worst second $worst kbit/s, $(dropped radio) packets dropped"
}

scenario_restart() { # one of a fleet that knows itself is killed and started again
  all_start
  watch_radio all_heard 20
  local before
  before=$(passed radio)
  kill -9 $(ip netns pids "$(space robot1)")
  : > "$out/r1.log"
  start 1
  watch_radio all_heard 15
  verdict $([[ -n $waited ]] && ((waited < 10000 && worst <= 160)) && echo 1 || echo 0) \
    "all known again after $(seconds_of "$waited"); $((($(passed radio) - before) / 1000)) kB in 15 s, worst second $worst kbit/s, $(dropped radio) packets dropped"
}

scenario_idle() { # what a fleet that waits costs
  all_start
  watch_radio all_heard 20
  local before
  before=$(passed radio)
  watch_radio never 60
  local rate=$((($(passed radio) - before) * 8 / 60 / 1000))
  verdict $((rate * 5 < radio && worst <= 160)) "$rate kbit/s over 60 s, worst second $worst kbit/s"
}

all_ended() {
  local i
  for ((i = 1; i <= agents; ++i)); do [[ -z $(ip netns pids "$(space "robot$i")") ]] || return 1; done
}
scenario_map() { # recordings are replayed in real time; all must end with the same whole map
  local i wifi_before maps
  [[ -d $recordings/r$agents ]] || { echo "--recordings $recordings: has no r$agents" >&2; exit 2; }
  idle=10
  wifi_before=$(passed wifi)
  all_start
  for ((i = 1; i <= agents; ++i)); do
    in_space "robot$i" "$program" replay -c "$scratch/r$i.yaml" "$recordings/r$i" >> "$out/replay$i.log" 2>&1 &
    disown $!
  done
  watch_radio all_ended 420
  maps=$(for ((i = 1; i <= agents; ++i)); do "$program" map info "$out/r$i/store.db" | sed -n 2p; done | sort | uniq -c)
  verdict $([[ -n $waited && $(wc -l <<< "$maps") == 1 && $maps != *" 0 alignments"* ]] && ((worst <= 160)) && echo 1 || echo 0) \
    "ended after $(seconds_of "$waited") with$maps; radio $((($(passed radio)) / 1000)) kB, worst second $worst kbit/s, $(dropped radio) dropped; Wi-Fi $((($(passed wifi) - wifi_before) / 1000000)) MB, $(dropped wifi) dropped"
}

declare -F "scenario_$scenario" > /dev/null || {
  echo "no scenario $scenario; there are: $(declare -F | sed -n 's/.* scenario_//p' | tr '\n' ' ')" >&2
  exit 2
}
for ((i = 1; i <= agents; ++i)); do make_space "robot$i"; done
medium radio 77 "$radio" 30000 "$agents"
medium wifi 78 "$wifi" 100000 "$agents"
write_configs
"scenario_$scenario"
