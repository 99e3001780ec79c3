# Sourced by field.sh: its robots, and waiting for them. Scenarios are in *scenarios.sh; a comment behind a name is for --list.

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
    "$program" run -c "$(fleet_file)" --agents "$agents" --record "$recordings" --record-format sqlite3 --out "$scratch/run" > "$scratch/run.log" 2>&1 ||
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
