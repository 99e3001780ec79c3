#!/usr/bin/env bash
# Entry point of a robot's container: robot.sh NUMBER ROBOTS_OF_THE_FLEET. All for other robots goes through the media;
# the agent keeps its store and map in /out/rNUMBER. If there is a recording /recordings/rNUMBER it is replayed, and the
# agent ends by itself when nothing happened for 10 s.
set -euo pipefail
number=$1
root=/fleetmap
agents=$2
out=/out
scratch=/run
qos=$root/qos
. "$root/deploy/compose/addresses.sh"
. "$root/deploy/netns/field_robots.sh"

route_through_medium() { # NET
  local device medium=10.$1.250.2
  device=$(device_of "$1")
  ip neigh replace "$medium" lladdr "$MEDIUM_MAC" dev "$device" nud permanent
  ip route add "$medium" dev "$device"
  ip route del "10.$1.0.0/16" dev "$device"
  ip route add "10.$1.0.0/16" via "$medium" dev "$device"
}
route_through_medium 77
route_through_medium 78

write_config "$number" "r$number" "$(names)"
idle=0
if [[ -d /recordings/r$number ]]; then
  idle=10
  fleetmap replay -c "$scratch/r$number.yaml" "/recordings/r$number" &
fi
exec fleetmap agent -c "$scratch/r$number.yaml" --exit-after-idle "$idle"
