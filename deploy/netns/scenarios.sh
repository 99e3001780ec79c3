# Sourced by field.sh: what happens in each scenario, and what must hold. A comment behind the name is for --list.

list_scenarios() { sed -n 's/^scenario_\([a-z_]*\)() { # /\1: /p' "$root"/deploy/netns/*scenarios.sh | column -t -s: -l 2; }

# ---- robots

names() {
  local i list=
  for ((i = 1; i <= agents; ++i)); do list+="${list:+, }r$i"; done
  echo "$list"
}
others() { # net, own number: addresses of the other robots
  local i list=
  for ((i = 1; i <= agents; ++i)); do ((i == $2)) || list+="${list:+, }10.$1.$i.2"; done
  echo "$list"
}
addresses() { # net: r1=10.NET.1.2,r2=...
  local i list=
  for ((i = 1; i <= agents; ++i)); do list+="${list:+,}r$i=10.$1.$i.2"; done
  echo "$list"
}
dds_of() { # robot number
  echo "{qos: $qos, onboard: {domain: $((10 + $1)), shared_memory: false}," \
    "long_range: {domain: 1, address: 10.77.$1.2, peers: [$(others 77 "$1")]}," \
    "short_range: {domain: 2, address: 10.78.$1.2, peers: [$(others 78 "$1")]}}"
}
make_keys() {
  local i
  keys=$scratch/keys
  { "$program" keys init --dir "$keys" && for ((i = 1; i <= agents; ++i)); do "$program" keys add "r$i" --dir "$keys"; done; } \
    > "$scratch/keys.log" || exit 2
}
write_config() { # robot number, name, names of its fleet
  cat > "$scratch/r$1.yaml" <<YAML
id: $2
fleet: [$3]
directory: $out/r$1
$(grep -vE '^(#|id:|fleet:|directory:)' "$root/config/agents/twin.yaml")
dds: $(dds_of "$1")
${keys:+keys: $keys/$2}
YAML
}
configuration() { # robot number: $configured are the arguments that tell its configuration
  configured=(-c "$scratch/r$1.yaml" "${settings[@]}")
  [[ -z $robot ]] || configured=(-c "$robot" --set "id=r$1" --set "fleet=[$(names)]" --set "directory=$out/r$1"
    --set "dds=$(dds_of "$1")" ${keys:+--set "keys=$keys/r$1"} "${settings[@]}")
}

start() { # robot number; its variables of the environment are in $environment, "NUMBER NAME=VALUE"
  local configured entry preload=()
  for entry in "${environment[@]}"; do [[ ${entry%% *} != "$1" ]] || preload+=("${entry#* }"); done
  configuration "$1"
  # exec, so that the process that is noted is the agent.
  (exec ip netns exec "$(space "robot$1")" env "${preload[@]}" "$program" agent "${configured[@]}" --exit-after-idle "${idle:-0}" >> "$out/r$1.log" 2>&1) &
  disown $!
  echo $! > "$scratch/r$1.pid"
}
keep_logs() { # and begin them anew, so that `says` counts what comes from now on
  local i
  for ((i = 1; i <= agents; ++i)); do
    cat "$out/r$i.log" >> "$out/r$i.before.log"
    : > "$out/r$i.log"
  done
}
play() { # robot number: its recording
  local configured
  configuration "$1"
  in_space "robot$1" "$program" replay "${configured[@]}" --rate "$rate" "$recordings/r$1" >> "$out/replay$1.log" 2>&1 &
  disown $!
}
crash() {
  local pid
  pid=$(cat "$scratch/r$1.pid")
  kill -9 "$pid"
  while kill -0 "$pid" 2> /dev/null; do sleep 0.02; done # it holds its store and ports until then
}
all_start() { local i; for ((i = 1; i <= agents; ++i)); do start $i; done; }
all_play() { local i; for ((i = 1; i <= agents; ++i)); do play $i; done; }

# More than five robots have a LiDAR of an eighth of the points, or two cores could not follow.
fleet_file() {
  ((agents > 5)) || { echo "$root/config/fleets/farm_small.yaml"; return; }
  local i
  {
    sed -e "s|\.\./|$root/config/|" -e 's/farm_60\.yaml/farm_120.yaml/' -e 's/vlp16\.yaml/vlp16-sparse.yaml/' \
      -e '/^agents:/,$d' "$root/config/fleets/farm_small.yaml"
    echo "agents:"
    for ((i = 1; i <= agents; ++i)); do echo "  - id: r$i"; done
  } > "$scratch/fleet.yaml"
  echo "$scratch/fleet.yaml"
}
need_recordings() {
  if [[ -z $recordings ]]; then
    recordings=$scratch/recordings
    echo "makes recordings of a small farm (a minute)" >&2
    "$program" run -c "$(fleet_file)" --agents "$agents" --record "$recordings" --out "$scratch/run" > "$scratch/run.log" 2>&1 ||
      { tail -n 5 "$scratch/run.log" >&2; exit 2; }
  fi
  [[ -d $recordings/r$agents ]] || { echo "--recordings $recordings: has no r$agents" >&2; exit 2; }
}

# ---- what is waited for

says() { grep -cE "$2" "$out/r$1.log" 2>/dev/null || true; } # robot number, pattern
# Number of others that a robot knows by the radio since its log was begun anew: it heard them, or another introduced them.
knows() { # robot number
  { grep -oE 'long_range: (heard|knows) r[0-9]+' "$out/r$1.log" 2>/dev/null || true; } | awk '{print $3}' | sort -u | wc -l
}
all_know() {
  local i
  for ((i = 1; i <= agents; ++i)); do (($(knows $i) >= agents - 1)) || return 1; done
}
all_ended() { # and have begun
  local i
  (($(now) - ${all_begun:=$(now)} > 5000000000)) || return 1
  for ((i = 1; i <= agents; ++i)); do [[ -z $(ip netns pids "$(space "robot$i")") ]] || return 1; done
}
never() { false; }
now() { date +%s%N; }

# Waits for `$1` at most `$2` s: $waited is then ms, else empty. Samples the radio each second into $series and $worst
# (kbit/s; $highest is that of all watches), and runs what $events lists ("SECONDS COMMAND").
events=()
highest=0 series=
watch_radio() { # condition, seconds
  local begin last second bytes time kbit due
  begin=$(now)
  read -r last second < <(passed_when radio)
  worst=0 waited= series=
  while :; do
    sleep 0.1
    if ((${#events[@]})); then
      due=${events[0]%% *}
      if (($(now) - begin >= due * 1000000000)); then
        ${events[0]#* }
        events=("${events[@]:1}")
      fi
    fi
    if [[ -z $waited ]] && $1; then waited=$((($(now) - begin) / 1000000)); fi
    if (($(now) - second >= 1000000000)); then
      read -r bytes time < <(passed_when radio)
      kbit=$(((bytes - last) * 8000000 / (time - second)))
      worst=$((kbit > worst ? kbit : worst))
      highest=$((kbit > highest ? kbit : highest))
      series+=" $kbit"
      last=$bytes second=$time
      note_use
    fi
    (($(now) - begin < $2 * 1000000000)) && [[ -z $waited || -z ${until_then:-} ]] || return 0
  done
}

# CPU seconds and the most memory (MB) of each agent, as of the last second in which it ran.
declare -A cpu_ticks=() peak_kb=()
note_use() {
  local i pid stat key value
  for ((i = 1; i <= agents; ++i)); do
    [[ -s $scratch/r$i.pid ]] && pid=$(< "$scratch/r$i.pid") && [[ -r /proc/$pid/stat ]] || continue
    { read -ra stat < "/proc/$pid/stat"; } 2> /dev/null || continue
    cpu_ticks[$i]=$((stat[13] + stat[14]))
    { while read -r key value _; do [[ $key != VmHWM: ]] || peak_kb[$i]=$value; done < "/proc/$pid/status"; } 2> /dev/null || true
  done
}
use_of_agents() {
  local i cpu= peak=
  for ((i = 1; i <= agents; ++i)); do
    cpu+=" $((${cpu_ticks[$i]:-0} / 100))"
    peak+=" $((${peak_kb[$i]:-0} / 1024))"
  done
  echo "CPU s:$cpu, peak MB:$peak"
}

seconds_of() { [[ -n $1 ]] && echo "$(($1 / 1000)).$(($1 / 100 % 10)) s" || echo "not in time"; }
verdict() { # holds (0 or 1), text
  echo "$scenario, $agents robots, $radio kbit/s${impairment[*]:+ (${impairment[*]})}${keys:+, with keys}: $2: $(((!$1)) && echo FAILED || echo ok)"
  echo "$scenario, $agents robots, kbit/s on the radio, second by second:$series" >> "$out/series.txt"
  (($1)) && return
  tail -n 20 "$out"/r*.log >&2
  return 1
}
radio_figures() { echo "$((($(passed radio) - ${before:-0}) / 1000)) kB, worst second $worst kbit/s, $(dropped radio) packets dropped"; }

# ---- knowing each other, without sensors

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

# ---- mapping: recordings are replayed in real time, and all must end by themselves with the same whole map

# Content of all stores, a line for each different one: number of stores, nodes, alignments, submaps.
holdings() {
  local i
  for ((i = 1; i <= agents; ++i)); do
    { "$program" map info --json "$out/r$i/store.db" 2> /dev/null || echo '{}'; } | python3 -c '
import json, sys
held = json.load(sys.stdin)
print(*([held["hash"][:8], held["nodes"], "nodes", held["alignments"], "alignments", held["submaps"], "submaps"] if held else ["no store"]))'
  done | sort | uniq -c | sed 's/^ *//'
}
is_whole_and_equal() { # holdings: 1 or 0. $gone submaps may have gone with a disk before anybody had them.
  [[ $(wc -l <<< "$1") == 1 && $1 == "$agents "* && $1 =~ ([0-9]+)" nodes "([1-9][0-9]*)" alignments "([0-9]+) ]] &&
    ((BASH_REMATCH[1] - BASH_REMATCH[3] <= ${gone:-0})) && echo 1 || echo 0
}
# Bytes of submaps that the robots must get from others, each its own excepted.
needed_bytes() {
  local i
  for ((i = 1; i <= agents; ++i)); do "$program" map info --json "$out/r$i/store.db" 2> /dev/null || true; done |
    sed -n 's/.*"submap_bytes": \([0-9]*\).*/\1/p' |
    awk -v robots="$agents" '{ sum += $1 } END { printf "%d", sum / robots * (robots - 1) }'
}
# Runs to the end; `check`, if set, names a command that must hold, too.
map_verdict() {
  local held equal needed on_air
  until_then=end
  watch_radio all_ended "$patience"
  held=$(holdings)
  equal=$(is_whole_and_equal "$held")
  needed=$(needed_bytes) on_air=$(passed wifi)
  "${check:-true}" || equal=0
  verdict $([[ -n $waited ]] && ((equal && worst <= radio * 4 / 5 && on_air < 2 * needed)) && echo 1 || echo 0) \
    "ended after $(seconds_of "$waited") with $(tr '\n' ';' <<< "$held") radio $(radio_figures); Wi-Fi $((on_air / 1000000)) MB for $((needed / 1000000)), $(dropped wifi) dropped; $(use_of_agents)"
}
begin_map() { # SECONDS after which a robot that has nothing to do ends
  need_recordings
  idle=${1:-10}
  all_start
  all_play
}

scenario_map() { # nothing goes wrong
  begin_map
  map_verdict
}

scenario_apart() { # no Wi-Fi until the recordings end: all but the submaps takes the radio
  off wifi
  begin_map
  events=("125 on wifi")
  map_verdict
}

scenario_radio_down() { # for 60 s
  begin_map
  events=("20 off radio" "80 on radio")
  map_verdict
}

scenario_kill() { # kill -9 of one while maps flow, started again 5 s later
  begin_map
  events=("40 crash 2" "45 start 2")
  map_verdict
}

scenario_kill_all() { # kill -9 of all at once, started again 5 s later
  begin_map
  crash_all() { local i; for ((i = 1; i <= agents; ++i)); do crash $i; done; }
  events=("50 crash_all" "55 all_start")
  map_verdict
}

scenario_new_disk() { # one is killed, and comes back with an empty disk
  local gone=2
  begin_map
  lose_disk() { crash 2; rm -rf "$out/r2"; }
  events=("60 lose_disk" "65 start 2")
  check() { (($(says 2 'lost, restored or replaced') == 1 && $(cat "$out"/r*.log | grep -c 'came under the name') == 0)); }
  check=check
  map_verdict
}

scenario_late() { # the last robot joins after a minute
  need_recordings
  idle=10
  come() { start "$agents"; play "$agents"; }
  for ((i = 1; i < agents; ++i)); do start $i; play $i; done
  events=("60 come")
  # The others end by themselves while they hear nobody who lacks anything, but not before they have heard of it.
  map_verdict
}

scenario_lidar_clock() { # one robot's LiDAR is 2 s behind its other sensors, another's jumps back by 5 s
  local i original
  need_recordings
  original=$recordings
  recordings=$scratch/shifted
  mkdir "$recordings"
  for ((i = 1; i <= agents; ++i)); do ln -s "$(realpath "$original")/r$i" "$recordings/r$i"; done
  rm "$recordings/r2" "$recordings/r3"
  "$root/deploy/netns/shift_stamps.py" "$original/r2" "$recordings/r2" /points -2
  "$root/deploy/netns/shift_stamps.py" "$original/r3" "$recordings/r3" /points -5 60
  begin_map
  check() { (($(says 2 'lidar: stamps are 2\.') == 1 && $(says 3 'lidar: stamps are [45]\.') == 1 && $(says 1 'stamps are') == 0)); }
  check=check
  map_verdict
}

# The measurements of `fleetmap trial`: field.json, and no verdict on how good it is.
scenario_trial() { # the robots get to know each other, then map; all that has come of it goes into field.json
  local known ended held i
  need_recordings
  idle=30 # candidates wait for 20 s, also those of two others
  if ((wifi_from > 0)); then off wifi; fi
  all_start
  until_then=known watch_radio all_know 60
  known=$waited
  all_play
  begin_traces
  if ((wifi_from > 0)); then events=("$wifi_from on wifi"); fi
  until_then=end watch_radio all_ended "$patience"
  ended=$waited
  # Those that still wait for something end now; they write what they have.
  for ((i = 1; i <= agents; ++i)); do kill -TERM "$(cat "$scratch/r$i.pid")" 2> /dev/null || true; done
  until_then=end watch_radio all_ended 60
  held=$(holdings)
  cat > "$out/field.json" <<JSON
{"all_know_s": $(json_seconds "$known"), "ended_s": $(json_seconds "$ended"), "worst_kbit_s": $highest,
 "equal": $(is_whole_and_equal "$held"),
 "radio_kb": $(($(passed radio) / 1000)), "radio_dropped": $(dropped radio),
 "wifi_mb": $(($(passed wifi) / 1000000)), "wifi_dropped": $(dropped wifi)}
JSON
  worst=$highest
  echo "trial, $agents robots, $radio kbit/s: $(tr '\n' ';' <<< "$held") $(radio_figures)"
}
json_seconds() { [[ -n $1 ]] && echo "$(($1 / 1000)).$(printf %03d $(($1 % 1000)))" || echo null; }

# ---- the Wi-Fi

# Stores of robots that mapped apart, and no Wi-Fi yet.
begin_apart() {
  local run=$scratch/apart i
  "$program" run -c "$root/config/fleets/farm_small.yaml" --agents "$agents" --set network.short_range.max_range=0.1 --set submap.voxel=0.02 --set submap.resolution=0.001 --out "$run" > "$scratch/run.log" 2>&1 || true
  for ((i = 1; i <= agents; ++i)); do
    [[ -f $run/r$i/store.db ]] || { tail -n 5 "$scratch/run.log" >&2; exit 2; }
    cp -r "$run/r$i" "$out/r$i"
  done
  off wifi
  all_start
  watch_radio all_know 10
}
submap_bytes() { # of each robot
  local i
  for ((i = 1; i <= agents; ++i)); do "$program" map info --json "$out/r$i/store.db"; done | sed -n 's/.*"submap_bytes": \([0-9]*\).*/\1/p'
}
all_whole() { # opening stores takes a robot's time, too: once a second
  (($(now) - ${looked:=0} > 1000000000)) || return 1
  looked=$(now)
  [[ $(holdings) == "$agents "* ]]
}
sum_of() { awk '{ sum += $1 } END { printf "%d", sum }'; }

scenario_contact() { # two robots that mapped apart meet for 20 s
  agents=2
  local held begun got
  begin_apart
  held=$(submap_bytes | sum_of)
  on wifi
  begun=$(passed wifi)
  until_then=whole watch_radio all_whole 20
  off wifi
  got=$(($(submap_bytes | sum_of) - held))
  local time=${waited:-20000}
  local share=$((got * 8 * 100 / wifi / time))
  verdict $((share >= 80)) \
    "$((got / 1000)) kB of submaps in $(seconds_of "$time"), $share % of $wifi kbit/s$([[ -z $waited ]] || echo ' (then both had all)'); $((($(passed wifi) - begun) / 1000)) kB on air, $(dropped wifi) packets dropped"
}

scenario_fair() { # three robots that mapped apart share one Wi-Fi that is too slow for all for 30 s
  agents=3
  local held got all least
  begin_apart
  held=$(submap_bytes)
  on wifi
  watch_radio never 30
  off wifi
  got=$(paste <(submap_bytes) <(echo "$held") | awk '{ print int(($1 - $2) / 1000) }')
  all=$(sum_of <<< "$got") least=$(sort -n <<< "$got" | head -n 1)
  verdict $((all * 8 >= 24 * wifi * 7 / 10 && least * 5 >= all)) \
    "kB of submaps that each got in 30 s at $wifi kbit/s: $(tr '\n' ' ' <<< "$got"), the least $((least * 100 / all)) % of all; $(dropped wifi) packets dropped"
}
