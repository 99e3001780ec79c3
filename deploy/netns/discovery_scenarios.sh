# Sourced by field.sh: scenarios of robots that get to know each other, without sensors.

scenario_discovery() { # all start at once
  before=$(passed radio)
  all_start
  watch_radio all_know 20
  verdict $([[ -n $waited ]] && ((waited < 10000 && worst <= radio * 4 / 5)) && echo 1 || echo 0) \
    "all know all after $(seconds_of "$waited"); in 20 s $(radio_figures)"
}

scenario_half_off() { # half of the fleet is switched off; of the others one comes 15 s late
  local on=$(((agents + 1) / 2)) i late_s
  present_know() { # those up to $present, each other
    for ((i = 1; i <= present; ++i)); do (($(knows $i) >= present - 1)) || return 1; done
  }
  local present=$((on - 1))
  before=$(passed radio)
  for ((i = 1; i <= present; ++i)); do start $i; done
  watch_radio present_know 15
  local first=$waited
  present=$on
  start $on
  watch_radio present_know 15
  late_s=$(seconds_of "$waited")
  worst=$highest
  verdict $([[ -n $first && -n $waited ]] && ((first < 10000 && waited < 10000 && worst <= radio * 4 / 5)) && echo 1 || echo 0) \
    "$((on - 1)) that are on know each other after $(seconds_of "$first"), with the late one after $late_s; in 30 s $(radio_figures)"
}

scenario_restart() { # each robot of a fleet that knows itself is killed and started again at once
  local killed slowest=0 in_time=1 until_then=
  known_again() { # each other has heard it anew, and it has heard them
    local i
    (($(knows "$killed") >= agents - 1)) || return 1
    for ((i = 1; i <= agents; ++i)); do
      ((i == killed || $(says $i "long_range: heard r$killed ") > 0)) || return 1
    done
  }
  all_start
  watch_radio all_know 20
  before=$(passed radio) highest=0
  for ((killed = 1; killed <= agents; ++killed)); do
    crash "$killed"
    keep_logs
    start "$killed"
    ((killed == agents)) || until_then=yes
    watch_radio known_again 15
    until_then=
    slowest=$((${waited:-15000} > slowest ? ${waited:-15000} : slowest))
    [[ -n $waited ]] || in_time=0
  done
  worst=$highest
  verdict $((in_time && slowest < 10000 && worst <= radio * 4 / 5)) \
    "all known again after at most $(seconds_of "$( ((in_time)) && echo $slowest || true)"); $(radio_figures)"
}

scenario_idle() { # what a fleet that waits costs
  all_start
  watch_radio all_know 20
  before=$(passed radio)
  watch_radio never 60
  local rate=$((($(passed radio) - before) * 8 / 60 / 1000))
  verdict $((rate * 5 < radio && worst <= radio * 4 / 5)) "$rate kbit/s over 60 s, worst second $worst kbit/s"
}

scenario_one_way() { # nothing reaches one robot for 15 s
  relay radio --block '*,10.77.1.2' "${impairment[@]}"
  all_start
  watch_radio never 15
  local deaf i known=1
  deaf=$(knows 1)
  for ((i = 2; i <= agents; ++i)); do (($(knows $i) >= agents - 2)) || known=0; done
  relay radio --delay 0 "${impairment[@]}"
  watch_radio all_know 20
  verdict $([[ -n $waited ]] && ((deaf == 0 && known && waited < 10000 && worst <= radio * 4 / 5)) && echo 1 || echo 0) \
    "the others knew each other meanwhile: $known; all know all $(seconds_of "$waited") after it hears again; worst second $worst kbit/s"
}

# The radio's device of robot 1. The route goes with the device.
radio_of_1() {
  ip -n "$(space robot1)" link set radio "$1"
  [[ $1 == down ]] || ip -n "$(space robot1)" route replace 10.77.0.0/16 via 10.77.1.1 dev radio
}

scenario_absent_interface() { # the radio of one robot comes up 8 s after its agent was started
  radio_of_1 down
  all_start
  events=("8 radio_of_1 up")
  watch_radio all_know 30
  verdict $([[ -n $waited ]] && ((waited < 20000 && worst <= radio * 4 / 5 && $(says 1 'silent until it is there') > 0)) && echo 1 || echo 0) \
    "all know all after $(seconds_of "$waited"); said: $(says 1 'silent until it is there')"
}

scenario_address_gone() { # the radio of one robot loses its address for 80 s, longer than the lease
  lose_address() { ip -n "$(space robot1)" addr flush dev radio; }
  regain_address() {
    ip -n "$(space robot1)" addr add 10.77.1.2/30 dev radio
    radio_of_1 up
  }
  all_start
  events=("5 lose_address" "85 regain_address")
  heard_again() { (($(says 2 'long_range: heard r1 ') >= 2)); }
  watch_radio heard_again 110
  verdict $([[ -n $waited ]] && ((waited < 100000 && worst <= radio * 4 / 5 && $(says 1 'silent until it is there') > 0)) && echo 1 || echo 0) \
    "said: $(says 1 'silent until it is there'); heard again after $(seconds_of "$waited")"
}

scenario_two_fleets() { # of one half of the robots each, on the same domain and addresses
  local i half=$((agents / 2)) first= second= alive=1 own=1
  for ((i = 1; i <= half; ++i)); do first+="${first:+, }r$i"; done
  for ((i = half + 1; i <= agents; ++i)); do second+="${second:+, }r$i"; done
  for ((i = 1; i <= agents; ++i)); do write_config $i "r$i" "$( ((i <= half)) && echo "$first" || echo "$second")"; done
  before=$(passed radio)
  all_start
  watch_radio never 20
  for ((i = 1; i <= agents; ++i)); do
    kill -0 "$(cat "$scratch/r$i.pid")" 2>/dev/null || alive=0
    (($(says $i 'is not of this fleet') > 0)) || own=0
  done
  verdict $((alive && own && worst <= radio * 4 / 5)) "each names the strangers: $own; all still run: $alive; in 20 s $(radio_figures)"
}

scenario_twins() { # two robots of one name
  write_config 2 r1 "$(names)"
  all_start
  named() { (($(says 1 'is named r1, too') > 0 && $(says 2 'is named r1, too') > 0)); }
  watch_radio named 20
  verdict $([[ -n $waited ]] && echo 1 || echo 0) "named in the log after $(seconds_of "$waited")"
}

scenario_check() { # check-config --network beside agents of which one has another voxel, one another domain, one is off
  ((agents >= 4)) || { echo "check: needs 4 agents" >&2; exit 2; }
  local found=1 pattern
  check_network() {
    local code=0
    in_space robot1 "$program" check-config --network --seconds 5 "$scratch/r1.yaml" \
      > "$out/check.txt" 2> "$out/check.log" || code=$?
    echo $code > "$out/check.code"
  }
  checked() { [[ -s $out/check.code ]]; }
  sed -i 's/^nodes:/submap: {voxel: 0.2}\nnodes:/' "$scratch/r2.yaml"
  sed -i 's/long_range: {domain: 1,/long_range: {domain: 3,/' "$scratch/r3.yaml"
  start 1
  start 2
  start 3
  watch_radio never 3
  before=$(passed radio)
  check_network &
  until_then=end watch_radio checked 30
  for pattern in '^  r2 .*10\.77\.2\.2:7660 .*heard after' "r2's submaps have voxels of 0.20 m, ours 0.10 m" \
    'heard r3 on domain 3: its file has dds.long_range.domain: 3, this one 1' '^  r4 .*never heard' \
    '^  r1 .*own agent' '10\.77\.4\.2:7660 .*nobody heard'; do
    grep -qE "$pattern" "$out/check.txt" || { found=0 && echo "not said: $pattern" >&2; }
  done
  (($(says 2 'heard check at .* \(an operator') > 0 && $(says 2 'check leaves') > 0)) || found=0
  ((found)) || cat "$out/check.txt" >&2
  verdict $((found && $(cat "$out/check.code") == 1 && worst <= radio * 4 / 5)) \
    "says all of it: $found, exit code $(cat "$out/check.code"), after $(seconds_of "$waited"); $(radio_figures)"
}

# A hub instead of the routed medium: what one robot sends reaches all, as on a radio with one channel. There is no Wi-Fi.
scenario_multicast() { # 30 s of mapping with one datagram for all, beside one for each robot
  local i with bytes=() nodes=()
  need_recordings
  hub
  off wifi
  for with in false true; do
    for ((i = 1; i <= agents; ++i)); do
      rm -rf "$out/r$i"
      write_config $i "r$i" "$(names)"
      sed -i "s/long_range: {[^}]*}/long_range: {domain: 1, address: 10.79.0.$i, multicast: $with, peers: [$(hub_others $i)]}/" "$scratch/r$i.yaml"
    done
    all_start
    until_then=known watch_radio all_know 20
    bytes+=($((-$(sent_to_hub))))
    all_play
    watch_radio never 30
    for ((i = 1; i <= agents; ++i)); do kill -TERM "$(cat "$scratch/r$i.pid")"; done
    until_then=gone watch_radio all_gone 30
    bytes[-1]=$((${bytes[-1]} + $(sent_to_hub) - $(clouds_that_came)))
    nodes+=("$("$program" map info --json "$out/r1/store.db" | sed -n 's/^  "nodes": \([0-9]*\).*/\1/p')")
    for ((i = 1; i <= agents; ++i)); do
      pkill -9 -f "replay -c $scratch/r$i.yaml" || true
      mv "$out/r$i.log" "$out/r$i.$with.log"
    done
  done
  verdict $((nodes[0] > 5 * agents && nodes[1] >= nodes[0] - agents && bytes[1] * 2 < bytes[0])) \
    "beside clouds all robots send $((bytes[0] / 1000)) kB with a datagram for each, $((bytes[1] / 1000)) kB with one for all; r1 holds ${nodes[0]} and ${nodes[1]} nodes"
}
clouds_that_came() { # bytes on the wire of pieces of clouds, each for one robot, with headers of 174 bytes
  python3 - "$out"/r*/report.json << 'PYTHON'
import json, sys
rows = [row for file in sys.argv[1:] for row in json.load(open(file))["topics"] if row["kind"] == "cloud_fragment"]
print(sum(row["received_bytes"] + 174 * row["received_messages"] for row in rows))
PYTHON
}
all_gone() {
  local i
  for ((i = 1; i <= agents; ++i)); do [[ ! -e /proc/$(cat "$scratch/r$i.pid") ]] || return 1; done
}
hub() {
  local i
  make_space hub
  ip -n "$(space hub)" link add hub type bridge mcast_snooping 0
  ip -n "$(space hub)" link set hub up
  for ((i = 1; i <= agents; ++i)); do
    ip link add hub netns "$(space "robot$i")" type veth peer name "robot$i" netns "$(space hub)"
    ip -n "$(space "robot$i")" addr add "10.79.0.$i/24" dev hub
    ip -n "$(space "robot$i")" link set hub up
    ip -n "$(space hub)" link set "robot$i" master hub
    ip -n "$(space hub)" link set "robot$i" up
  done
}
hub_others() { # own number
  local i list=
  for ((i = 1; i <= agents; ++i)); do ((i == $1)) || list+="${list:+, }10.79.0.$i"; done
  echo "$list"
}
sent_to_hub() { # bytes, of all robots
  local i sum=0
  for ((i = 1; i <= agents; ++i)); do sum=$((sum + $(in_space "robot$i" cat /sys/class/net/hub/statistics/tx_bytes))); done
  echo $sum
}
