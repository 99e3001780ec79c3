# Sourced by field.sh: scenarios of mapping. Recordings are replayed in real time, and all must end by themselves with
# the same whole map.

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
