#!/usr/bin/env bash
# Entry point of the container of a medium: what robots send to each other passes one queue that all share.
#
#   robots --- device --> out --[queue]--> in --> device --- robots
#                                          in --[relay.py]--> back --> from --> device --- robots   (with impairments)
#
# NET, KBIT and QUEUE_BYTES say which medium it is; RELAY holds options of relay.py, which runs if one is not 0.
set -euo pipefail
root=/fleetmap
. "$root/deploy/compose/addresses.sh"
. "$root/deploy/netns/medium.sh"
in_space() { shift; "$@"; } # the container is the only space

pair() {
  ip link add "$1" type veth peer name "$2"
  ip link set "$1" up
  ip link set "$2" up
}
mac_of() { cat "/sys/class/net/$1/address"; }

device=$(device_of "$NET")
beyond=169.254.0.1 # stands for the other end of `out`: an address that nobody has
pair out in
ip neigh add "$beyond" lladdr "$(mac_of in)" dev out nud permanent
ip route add default via "$beyond" dev out onlink table 100
ip route add blackhole default table 100 metric 1000 # while `out` is down
ip rule add iif "$device" lookup 100
shape "" "$KBIT" "$QUEUE_BYTES"

process=(sleep infinity)
if [[ $RELAY =~ [1-9] ]]; then
  pair back from
  ip rule add iif in blackhole # relay.py takes the frames from there
  process=(python3 "$root/deploy/netns/relay.py" in back --to-mac "$(mac_of from)" $RELAY)
fi
trap 'exit 0' TERM INT
"${process[@]}" &
ip link set "$device" address "$MEDIUM_MAC"
echo "$KBIT kbit/s, queue of $QUEUE_BYTES bytes, relay $RELAY"
wait $!
