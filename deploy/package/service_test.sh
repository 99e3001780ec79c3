#!/usr/bin/env bash
# Runs the service fleetmap-agent@r1 under systemd, which boots a Debian root with fleetmap in namespaces of its own: ready
# once the agent says so, restarted by its watchdog when it hangs and after a crash, going on with its store, ended with a
# map, and loud when its configuration is wrong.
#   deploy/package/service_test.sh ROOT RECORDING    ROOT: a Debian 12 with fleetmap's package and systemd-sysv (root)
#                                                    RECORDING: of a VLP-16, its path within ROOT
set -euo pipefail
debian=$(realpath "$1")
recording=$2
group=/sys/fs/cgroup
[ -d "$group/unified" ] && group=$group/unified  # beside the groups of version 1
group=$group/fleetmap-service-$$
output=$(mktemp)

# A group of control groups of its own, so that systemd sees no other.
boot() {
  echo "$BASHPID" > "$group/cgroup.procs"
  exec unshare --cgroup --mount --pid --fork --uts --ipc --net --kill-child bash -euc '
    cd "$0"
    mount --make-rprivate /
    mount --bind . .
    cd "$0"
    mount -t proc proc proc
    mount -t sysfs -o ro sysfs sys
    mount -t cgroup2 cgroup2 sys/fs/cgroup
    mount -t tmpfs tmpfs run
    mount -t tmpfs -o mode=755 tmpfs dev
    mkdir dev/pts dev/shm
    mount -t devpts -o newinstance,ptmxmode=666 devpts dev/pts
    ln -s pts/ptmx dev/ptmx
    mount -t tmpfs tmpfs dev/shm
    while read -r name major minor; do mknod -m 666 "dev/$name" c "$major" "$minor"; done <<< "null 1 3
zero 1 5
full 1 7
random 1 8
urandom 1 9
tty 5 0"
    ip link set lo up multicast on
    pivot_root . mnt  # in a chroot no user namespace is allowed, which PrivateUsers needs
    umount -l /mnt
    exec env -i container=namespaces PATH=/usr/sbin:/usr/bin:/sbin:/bin /lib/systemd/systemd
  ' "$debian" < /dev/null > "$output" 2>&1
}
mkdir "$group"
boot &
booting=$!
finish() {
  kill -9 "$booting" 2> /dev/null || true
  wait "$booting" 2> /dev/null || true
  until grep -q 'populated 0' "$group/cgroup.events"; do sleep 0.1; done
  find "$group" -depth -type d -exec rmdir {} \;
  rm -f "$output"*
}
trap finish EXIT

until init=$(pgrep -P "$booting" -f /lib/systemd/systemd); do
  kill -0 "$booting" 2> /dev/null || { cat "$output" >&2; exit 1; }
  sleep 0.2
done
inside() { nsenter --target "$init" --all "$@"; }
unit=fleetmap-agent@r1
state() { inside systemctl show --value -p "$1" "$unit"; }
give_up() { echo "$1" >&2; cat "$output".* >&2; inside journalctl --no-pager -u "$unit" | tail -n 30 >&2; exit 1; }
wait_for() {  # SECONDS SENTENCE COMMAND...
  local end=$((SECONDS + $1))
  until "${@:3}" > /dev/null 2>&1; do
    ((SECONDS < end)) || give_up "not within $1 s: $2"
    sleep 0.5
  done
  echo "$2"
}
restarted() { [ "$(state NRestarts)" = "$1" ] && [ "$(state ActiveState)" = active ]; }

wait_for 60 "systemd runs" inside systemctl list-units
mkdir -p "$debian/etc/fleetmap"
sed 's#^directory: .*#directory: /var/lib/fleetmap/r1#; s#^  qos: .*#  qos: /usr/share/fleetmap/qos#' \
  "$debian/usr/share/fleetmap/config/agents/r1.yaml" > "$debian/etc/fleetmap/r1.yaml"
inside systemctl enable -q --now "$unit" || give_up "the agent does not start"  # returns once it says that it is ready
restarted 0 || give_up "the agent is not active once it was started"
echo "started, and enabled for the next boot: $(inside systemctl is-enabled "$unit")"

store=/var/lib/fleetmap/r1/store.db
nodes() { inside fleetmap map info "$store" | sed -n 's/^nodes \([0-9]*\),.*/\1/p'; }
has_more_nodes_than() { local now; now=$(nodes) && ((now > $1)); }
drive() {  # in the background: the robot's sensors
  inside fleetmap replay -c /etc/fleetmap/r1.yaml --set dds.onboard.shared_memory=false "$recording" > "$output.drive" 2>&1 &
}
drive
wait_for 60 "it maps" has_more_nodes_than 3
wait %2 || { cat "$output.drive" >&2; exit 1; }
before=$(nodes)

inside systemctl kill --kill-who=main --signal=STOP "$unit"  # it hangs
wait_for 90 "hung: the watchdog ended it, and it runs again" restarted 1
inside journalctl --no-pager -u "$unit" | grep -q 'Watchdog timeout' || give_up "the watchdog says nothing"

inside systemctl kill --kill-who=main --signal=KILL "$unit"
wait_for 60 "killed: it runs again" restarted 2

inside journalctl --no-pager -o cat -u "$unit" | grep -q "going on from $before nodes" || give_up "it forgot its nodes"
drive
wait_for 60 "it goes on from $before nodes" has_more_nodes_than "$before"

inside systemctl stop "$unit"
[ -s "$debian/var/lib/fleetmap/r1/map.ply" ] || give_up "it wrote no map"
[ "$(state Result)" = success ] && [ "$(state ExecMainStatus)" = 0 ] || give_up "stopped with $(state Result), $(state ExecMainStatus)"
echo "stopped with a map of $(nodes) nodes"

sed -i 's#model: vlp16#model: vlp61#' "$debian/etc/fleetmap/r1.yaml"
if inside systemctl start "$unit" 2> /dev/null; then give_up "a wrong configuration is started"; fi
inside journalctl --no-pager -o cat -u "$unit" | tail -n 20 | grep -m 1 'vlp61' || give_up "the journal does not name the wrong setting"
inside systemctl stop "$unit"
echo "service: ok"
