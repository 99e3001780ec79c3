# Sourced by field.sh: scenarios in which a disk, a clock, an address, a datagram or an operator does what it should not.

# ---- configuration

scenario_no_address() { # robots whose files name no own address refuse to start, and list the interfaces of this machine
  local i code refused=0 listed=0
  for ((i = 1; i <= agents; ++i)); do
    sed -i "s/address: 10\.77\.$i\.2, //" "$scratch/r$i.yaml"
    code=0
    in_space "robot$i" "$program" agent -c "$scratch/r$i.yaml" > "$out/r$i.log" 2>&1 || code=$?
    ((code == 0)) || refused=$((refused + 1))
    ! grep -q "long_range.address is not set.*radio 10\.77\.$i\.2.*wifi 10\.78\.$i\.2" "$out/r$i.log" || listed=$((listed + 1))
  done
  verdict $((refused == agents && listed == agents)) "$refused refused, $listed with both interfaces listed, $(passed radio) bytes on the radio"
}

scenario_other_address() { # the radio of one robot has another address for 40 s while it maps
  other_address() {
    ip -n "$(space robot1)" addr add 10.77.99.1/32 dev radio
    ip -n "$(space robot1)" addr del 10.77.1.2/30 dev radio
  }
  own_address() {
    ip -n "$(space robot1)" addr flush dev radio
    ip -n "$(space robot1)" addr add 10.77.1.2/30 dev radio
    radio_of_1 up
  }
  begin_map
  events=("30 other_address" "70 own_address")
  check() { (($(says 1 'radio 10\.77\.99\.1.*silent until it is there') == 1)); }
  check=check
  map_verdict
}

# ---- disk

scenario_full_disk() { # the disk of one robot is full for a while; then there is room again
  mkdir "$out/r2"
  mount -t tmpfs -o size=4m fleetmap-field "$out/r2"
  MOUNTS+=("$out/r2")
  make_room() { mount -o remount,size=400m "$out/r2"; }
  begin_map
  events=("100 make_room")
  local was_full
  check() {
    was_full=$(says 2 'full')
    ((was_full > 0 && $(wc -l < "$out/r2.log") < 300))
  }
  check=check
  map_verdict
  echo "  its log has $(wc -l < "$out/r2.log") lines, $was_full of them about the disk"
}

# ---- the Wi-Fi

scenario_damage() { # one in 300 large datagrams of the Wi-Fi has a flipped bit
  relay wifi --damage 0.3 "${wifi_impairment[@]}"
  begin_map
  local damaged
  check() {
    damaged=$(cat "$out"/r*/report.json | grep -c '"submaps_with_wrong_hash": [1-9]' || true)
    ((damaged > 0))
  }
  check=check
  map_verdict
  echo "  $damaged robots got submaps that did not have their hash"
}

# ---- clocks

# Builds a library that sets the clock of one process: as faketime does, which Debian's base has not, and time namespaces
# only shift clocks that nobody sets.
scenario_clock_back() { # the system clock of one robot is set back by 600 s while it maps
  command -v cc > /dev/null || { echo "skipped: needs cc"; exit 77; }
  cc -shared -fPIC -O1 -o "$scratch/set_clock.so" "$root/deploy/netns/set_clock.c" -ldl
  echo 0 > "$scratch/offset"
  set_back() { echo -600 > "$scratch/offset"; }
  environment=("2 LD_PRELOAD=$scratch/set_clock.so" "2 SET_CLOCK_FILE=$scratch/offset")
  begin_map
  events=("40 set_back")
  map_verdict
}

# ---- the end

scenario_sigterm() { # one robot is told to end while all map: the others hold its last node, too
  local left submaps
  begin_map
  end_one() { kill -TERM "$(cat "$scratch/r2.pid")"; }
  events=("60 end_one")
  until_then=end watch_radio all_ended "$patience"
  pkill -9 -f "replay -c $scratch/r2.yaml" || true
  of_2() { # nodes or submaps of it in each store, a line for each different number
    for ((i = 1; i <= agents; ++i)); do
      "$program" map info --json "$out/r$i/store.db" | python3 -c 'import json, sys; print(json.load(sys.stdin)["robots"]["r2"][sys.argv[1]], sys.argv[1])' "$1"
    done | sort | uniq -c | sed 's/^ *//'
  }
  left=$(of_2 nodes)
  submaps=$(of_2 submaps)
  verdict $([[ -n $waited && $left == "$agents "* ]] && echo 1 || echo 0) "of r2 the robots hold: $(tr '\n' ';' <<< "$left$submaps") radio $(radio_figures)"
}

# ---- a newcomer's path

# The machines are namespaces on one switch; the file and the commands are those of docs/three_machines.md, word for word
# but for the robot's number.
scenario_three_machines() { # docs/three_machines.md, taken literally
  agents=3
  local i guide=$root/docs/three_machines.md heard checked=0 machine
  need_recordings
  hub
  on_machine() { # number, command of the guide for r1
    in_space "robot$1" env -C "$scratch/machine$1" bash -c "${2//r1/r$1}"
  }
  command_of_guide() { grep -o '`build/release/bin/fleetmap '"$1"'[^`]*`' "$guide" | head -n 1 | tr -d '`'; }
  for ((i = 1; i <= agents; ++i)); do
    machine=$scratch/machine$i
    mkdir -p "$machine/build/release/bin"
    ln -s "$(realpath "$program")" "$machine/build/release/bin/fleetmap"
    ln -s "$root/qos" "$machine/qos"
    ln -s "$(realpath "$recordings")" "$machine/rec"
    ln -s "$(realpath "$out")" "$machine/out"
    ip -n "$(space "robot$i")" addr add "10.0.0.$i/24" dev hub
    sed -n '/```yaml/,/```/{/```/d;s/^   //;p}' "$guide" |
      sed -e "s/^id: r1/id: r$i/" -e "s|out/r1|out/r$i|" -e "s/domain: 11/domain: 1$i/" \
        -e "s/address: 10.0.0.1, peers: \[.*\]/address: 10.0.0.$i, peers: [$(hub_others $i | sed 's/10\.79\.0/10.0.0/g')]/" > "$machine/r$i.yaml"
    on_machine $i "$(command_of_guide 'check-config r1')" > "$out/check$i.txt" 2>&1 || cat "$out/check$i.txt" >&2
    on_machine $i "exec $(command_of_guide agent)" > "$out/r$i.log" 2>&1 &
    disown $!
  done
  until_then=known watch_radio all_know 20
  heard=$waited
  for ((i = 1; i <= agents; ++i)); do
    ! on_machine $i "$(command_of_guide 'check-config --network')" > "$out/network$i.txt" 2>&1 || checked=$((checked + 1))
    on_machine $i "$(command_of_guide replay)" > "$out/replay$i.log" 2>&1 &
    disown $!
  done
  until_then=end watch_radio all_ended "$patience"
  local held maps=0
  for ((i = 1; i <= agents; ++i)); do
    on_machine $i "$(command_of_guide 'map info')" > "$out/info$i.json"
    [[ ! -s $out/r$i/map.ply ]] || maps=$((maps + 1))
  done
  held=$(sed -n 's/.*"hash": "\([^"]*\)".*/\1/p' "$out"/info?.json | sort | uniq -c | sed 's/^ *//')
  verdict $([[ -n $waited && -n $heard && $held == "3 "* ]] && ((checked == 3 && maps == 3)) && echo 1 || echo 0) \
    "all know all after $(seconds_of "$heard"), check-config --network content on $checked; ended after $(seconds_of "$waited"): $(tr '\n' ';' <<< "$held") $maps maps"
}
