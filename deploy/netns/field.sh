#!/usr/bin/env bash
# Agents as processes, each in a network namespace, around one radio and one Wi-Fi that they share. Root; needs iproute2
# and a built program. Namespaces are its own and go when it ends, also when it is interrupted.
#   deploy/netns/field.sh --agents N --scenario NAME [--radio KBIT] [--program FILE] [--out DIR]
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
usage() { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
while (($#)); do
  (($# > 1)) || usage
  case $1 in
    --agents) agents=$2 ;;
    --scenario) scenario=$2 ;;
    --radio) radio=$2 ;;
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
lidar: {model: vlp16}
dds:
  qos: $root/qos
  onboard: {domain: $((10 + i)), shared_memory: false}
  long_range: {domain: 1, address: 10.77.$i.2, peers: [$(others 77 $i)]}
  short_range: {domain: 2, address: 10.78.$i.2, peers: [$(others 78 $i)]}
YAML
  done
}

start() { # robot number
  in_space "robot$1" "$program" agent -c "$scratch/r$1.yaml" --exit-after-idle 0 >> "$out/r$1.log" 2>&1 &
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
    (($(now) - begin < $2 * 1000000000)) || return 0
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

declare -F "scenario_$scenario" > /dev/null || {
  echo "no scenario $scenario; there are: $(declare -F | sed -n 's/.* scenario_//p' | tr '\n' ' ')" >&2
  exit 2
}
for ((i = 1; i <= agents; ++i)); do make_space "robot$i"; done
medium radio 77 "$radio" 30000 "$agents"
medium wifi 78 "$wifi" 100000 "$agents"
write_configs
"scenario_$scenario"
