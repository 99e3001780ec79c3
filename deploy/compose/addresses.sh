# Sourced by the entry points: robot i is 10.NET.i.2 as in deploy/netns, a medium is 10.NET.250.2;
# the radio's NET is 77, the Wi-Fi's 78.

# Frames that a medium shall carry go to this address, which it takes when its queue is ready. Before that, and while it
# is stopped, they are lost: a medium that forwarded earlier would also tell robots the direct way (ICMP redirect).
MEDIUM_MAC=02:00:00:00:00:01

# The device whose address is in 10.$1.0.0/16: engines name devices in an order of their own.
device_of() {
  local device
  device=$(ip -o -4 addr show to "10.$1.0.0/16" | awk '{ print $2; exit }')
  [[ -n $device ]] || { echo "no device has an address in 10.$1.0.0/16" >&2; return 1; }
  echo "$device"
}
