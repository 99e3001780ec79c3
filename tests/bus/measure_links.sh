#!/bin/sh
# Measures the radio profiles between two network namespaces. Needs root, iproute2 and a built link_meter.
#   measure_links.sh BUILD_DIR [SECONDS [LINKS]], LINKS being "long short" or one of them
# Prints the arrangement and then a JSON line of each end. docs/journal/dds_2026_11.md holds the table.
set -eu
build=$1
seconds=${2:-40}
links=${3:-long short}
root=$(cd "$(dirname "$0")/../.." && pwd)
meter=$build/bin/link_meter
a=fm-a-$$
b=fm-b-$$
m=fm-m-$$ # between them: loses datagrams
scratch=$(mktemp -d)
relay=
cleanup() {
  [ -z "$relay" ] || kill $relay 2>/dev/null || true
  for space in $a $b $m; do ip netns del $space 2>/dev/null || true; done
  rm -rf "$scratch"
}
trap cleanup EXIT
trap "exit 1" INT TERM

for space in $a $b $m; do
  ip netns add $space
  ip netns exec $space sysctl -q -w net.ipv6.conf.default.disable_ipv6=1 2>/dev/null || true
  ip -n $space link set lo up
done
ip link add va netns $a type veth peer name ma netns $m
ip link add vb netns $b type veth peer name mb netns $m
ip -n $a addr add 10.9.8.1/24 dev va
ip -n $b addr add 10.9.8.2/24 dev vb
for end in "$a va" "$b vb" "$m ma" "$m mb"; do
  set -- $end
  ip -n $1 link set dev $2 up
done
until [ "$(ip netns exec $a cat /sys/class/net/va/operstate)" = up ]; do :; done
until [ "$(ip netns exec $b cat /sys/class/net/vb/operstate)" = up ]; do :; done

shape() { # rate, burst, limit (bytes), loss (%)
  tc -n $a qdisc replace dev va root tbf rate $1 burst $2 limit $3
  tc -n $b qdisc replace dev vb root tbf rate $1 burst $2 limit $3
  [ -z "$relay" ] || kill $relay
  ip netns exec $m python3 "$root/deploy/netns/relay.py" ma mb --both --loss $4 &
  relay=$!
}

run() { # title, link, qos directory, options of the sender
  echo "## $1"
  link=$2
  qos=$3
  shift 3
  ip netns exec $b $meter $link-receive --iface vb --address 10.9.8.2 --peer 10.9.8.1 --qos "$qos" --seconds $seconds &
  receiver=$!
  ip netns exec $a $meter $link-send --iface va --address 10.9.8.1 --peer 10.9.8.2 --qos "$qos" --seconds $seconds "$@" ||
    echo "the sender failed"
  wait $receiver || echo "the receiver failed"
}

# The long-range profile with Fast DDS's flow controller: asynchronous writers, so many bytes per 100 ms. It stands in
# the participant since Fast DDS 2.9 registers those of writers under one name per participant, and the first wins.
with_controller() { # directory, bytes per period
  mkdir -p "$1"
  cp "$root"/qos/*.xml "$1"
  sed -e 's/SYNCHRONOUS/ASYNCHRONOUS/' -e "s|<useBuiltinTransports>|<throughputController><bytesPerPeriod>$2</bytesPerPeriod><periodMillisecs>100</periodMillisecs></throughputController>&|" \
    "$root/qos/long_range.xml" >"$1/long_range.xml"
}
with_controller "$scratch/controller" 2000 # 160 kbit/s
with_controller "$scratch/fence" 2500      # 200 kbit/s

case $links in *long*)
  for loss in 0 10; do
    shape 200kbit 3000 20000 $loss
    run "long range, not limited, loss $loss %" long "$root/qos"
    run "long range, flow controller at 160 kbit/s, loss $loss %" long "$scratch/controller"
    run "long range, own bucket at 160 kbit/s, loss $loss %" long "$root/qos" --bucket 160
    run "long range, own bucket and flow controller at 200 kbit/s, loss $loss %" long "$scratch/fence" --bucket 160
  done
  ;;
esac
case $links in *short*)
  for loss in 0 1; do
    shape 15mbit 16000 150000 $loss
    run "short range, loss $loss %" short "$root/qos"
  done
  ;;
esac
