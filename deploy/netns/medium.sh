# Sourced by field.sh: robots in network namespaces of their own around two media, each behind one queue that all share.
#
#   robot i --- veth --- air --[queue of the radio]--> ether --- veth --- air --- veth --- robot j
#
# Every packet of every robot passes the queue once, whoever it is for: so robots share the rate as on one channel.
# Addresses: robot i is 10.77.i.2 on the radio and 10.78.i.2 on the Wi-Fi.

FIELD=fmfield$$
SPACES=()
declare -A GATEWAY  # of each medium: behind its queue

space() { echo "$FIELD-$1"; }
in_space() { local name=$1; shift; ip netns exec "$(space "$name")" "$@"; }

make_space() {
  ip netns add "$(space "$1")"
  SPACES+=("$1")
  ip -n "$(space "$1")" link set lo up
  in_space "$1" sysctl -qw net.ipv4.ip_forward=1 net.ipv4.conf.all.rp_filter=0 net.ipv4.conf.default.rp_filter=0 \
    net.ipv4.conf.all.send_redirects=0 net.ipv4.conf.default.send_redirects=0
}

join() { # space, device, address/prefix, space, device, address/prefix
  ip link add "$2" netns "$(space "$1")" type veth peer name "$5" netns "$(space "$4")"
  ip -n "$(space "$1")" addr add "$3" dev "$2"
  ip -n "$(space "$4")" addr add "$6" dev "$5"
  ip -n "$(space "$1")" link set "$2" up
  ip -n "$(space "$4")" link set "$5" up
}

# medium NAME NET RATE QUEUE_BYTES AGENTS: NET is the second number of its addresses
medium() {
  local name=$1 net=$2 rate=$3 queue=$4 agents=$5 i
  GATEWAY[$name]=10.$net.250.2
  make_space "$name-air"
  make_space "$name-ether"
  join "$name-air" out "10.$net.250.1/30" "$name-ether" in "10.$net.250.2/30"
  join "$name-ether" back "10.$net.251.1/30" "$name-air" from "10.$net.251.2/30"
  ip -n "$(space "$name-ether")" route add "10.$net.0.0/16" via "10.$net.251.2" dev back
  ip -n "$(space "$name-air")" route add default via "10.$net.250.2" dev out table 100
  # While the medium is off, nothing finds a way around its queue.
  ip -n "$(space "$name-air")" route add blackhole default table 100 metric 1000
  shape "$name" "$rate" "$queue"
  for ((i = 1; i <= agents; ++i)); do
    join "robot$i" "$name" "10.$net.$i.2/30" "$name-air" "robot$i" "10.$net.$i.1/30"
    ip -n "$(space "robot$i")" route add "10.$net.0.0/16" via "10.$net.$i.1" dev "$name"
    ip -n "$(space "$name-air")" rule add iif "robot$i" lookup 100
  done
}

shape() { # medium, rate (kbit), bytes that wait at most
  in_space "$1-air" tc qdisc replace dev out root tbf rate "$2kbit" burst 3000 limit "$3"
}

off() { ip -n "$(space "$1-air")" link set out down; } # nothing passes the medium
on() { # the route went with the link
  ip -n "$(space "$1-air")" link set out up
  ip -n "$(space "$1-air")" route replace default via "${GATEWAY[$1]}" dev out table 100
}

# Puts a relay (relay.py) behind the queue of a medium, or another in its place: relay MEDIUM OPTIONS...
declare -A RELAYS=()
relay() {
  local name=$1 mac
  shift
  [[ -z ${RELAYS[$name]:-} ]] || kill "${RELAYS[$name]}" 2>/dev/null || true
  while [[ -n $(ip netns pids "$(space "$name-ether")") ]]; do sleep 0.1; done
  in_space "$name-ether" sysctl -qw net.ipv4.ip_forward=0
  mac=$(in_space "$name-air" cat /sys/class/net/from/address)
  # exec, so that the process that is noted is the relay.
  (exec ip netns exec "$(space "$name-ether")" python3 "$root/deploy/netns/relay.py" in back --to-mac "$mac" --seed "$seed" "$@") &
  RELAYS[$name]=$!
  disown $!
}
begin_traces() { # of the relays that have one
  local name
  for name in "${!RELAYS[@]}"; do kill -USR1 "${RELAYS[$name]}"; done
}

# Bytes that passed the queue of a medium, and packets that it dropped.
passed() { in_space "$1-air" cat /sys/class/net/out/statistics/tx_bytes; }
# Bytes and the time (ns) at which they were read, by one process: on a busy machine two would be far apart.
passed_when() {
  in_space "$1-air" bash -c 'read -r bytes < /sys/class/net/out/statistics/tx_bytes; echo "$bytes ${EPOCHREALTIME/./}000"'
}
dropped() { in_space "$1-air" tc -s qdisc show dev out | sed -n 's/.*dropped \([0-9]*\).*/\1/p'; }

remove_spaces() {
  local name pid
  for name in "${SPACES[@]}"; do
    for pid in $(ip netns pids "$(space "$name")" 2>/dev/null); do kill -9 "$pid" 2>/dev/null || true; done
    ip netns del "$(space "$name")" 2>/dev/null || true
  done
}
