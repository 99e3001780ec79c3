#!/usr/bin/env bash
# Makes build/release/fleetmap_VERSION_ARCH.deb from a release build.
#   deploy/package.sh
#   deploy/package.sh --test    also installs it into a clean Debian 12 (debootstrap, root), runs a fleet there, and has
#                               systemd check the service
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD

./deploy/install-dependencies.sh
cmake --preset release > /dev/null
cmake --build --preset release --target fleetmap
(cd build/release && rm -f fleetmap_*.deb && cpack > cpack.log) || { cat build/release/cpack.log; exit 1; }
package=$(ls build/release/fleetmap_*.deb)
echo "$package: $(du -k "$package" | cut -f1) kB, $(dpkg-deb -f "$package" Depends | tr ',' '\n' | wc -l) dependencies"
[ "${1:-}" = --test ] || exit 0

command -v debootstrap > /dev/null || { echo "install debootstrap first" >&2; exit 1; }
debian=$(mktemp -d)
chmod 755 "$debian"
trap 'rm -rf "$debian"' EXIT
debootstrap --variant=minbase bookworm "$debian" > "$debian.log" 2>&1 || { tail "$debian.log"; exit 1; }
rm -f "$debian.log"
cp "$package" "$debian/tmp/fleetmap.deb"
cp -r "$root/config" "$debian/tmp/config"
in_debian() { chroot "$debian" env DEBIAN_FRONTEND=noninteractive "$@"; }
in_debian apt-get -qq update
in_debian apt-get install -y -qq --no-install-recommends /tmp/fleetmap.deb > "$debian/tmp/install.log" 2>&1 ||
  { tail -n 20 "$debian/tmp/install.log"; exit 1; }
echo "installed into a clean Debian 12: $(du -sm --exclude=proc "$debian" | cut -f1) MB with all dependencies"
in_debian getent passwd fleetmap
in_debian fleetmap --version
in_debian fleetmap run -c /usr/share/fleetmap/config/fleets/farm_small.yaml --agents 2 --set max_time=60 \
  --record /tmp/recordings --out /tmp/out > "$debian/tmp/run.log" 2>&1 || true  # cut off: not all rows are driven
in_debian fleetmap inspect /tmp/recordings/r1
in_debian fleetmap odometry /tmp/recordings/r1 --out /tmp/o.tum --set lidar.model=vlp16
in_debian bash -euc 'load() { . /usr/share/bash-completion/completions/fleetmap; }
  load  # in a function, as bash-completion does
  COMP_WORDS=(fleetmap map in) COMP_CWORD=2 && _fleetmap && test "${COMPREPLY[*]}" = info'
if command -v man > /dev/null; then  # by that of this machine
  MANWIDTH=100 man --warnings -l "$debian/usr/share/man/man1/fleetmap.1" > "$debian/tmp/page" 2> "$debian/tmp/page.errors" ||
    { cat "$debian/tmp/page.errors"; exit 1; }
  grep -q 'fleetmap map info' "$debian/tmp/page"
  [ ! -s "$debian/tmp/page.errors" ] || { cat "$debian/tmp/page.errors"; exit 1; }
fi
in_debian test -s /tmp/out/r1/map.ply -a -s /tmp/o.tum
# systemd itself is not among the dependencies, so the service is checked by that of this machine.
service=$debian/tmp/fleetmap-agent@r1.service
sed "s#/usr/bin/fleetmap#$root/build/release/bin/fleetmap#" "$debian/usr/lib/systemd/system/fleetmap-agent@.service" > "$service"
systemd-analyze verify --man=no "$service"
systemd-analyze security --offline=yes --threshold=29 "$service" | tail -n 1
echo "package: ok"
