#!/usr/bin/env bash
# Makes Debian packages in build/release from a release build: fleetmap, fleetmap-twin, fleetmap-gis and fleetmap-dev.
#   deploy/package.sh
#   deploy/package.sh --test    also installs them into a clean Debian 12 (debootstrap, root), runs a fleet and Ansible's
#                               role there, compiles a program with the libraries, and boots it with systemd, whose
#                               service must map, survive a hang and a crash, and go on
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD

./deploy/install-dependencies.sh
cmake --preset release -DFLEETMAP_UNITY=ON > /dev/null
cmake --build --preset release --target fleetmap
(cd build/release && rm -f fleetmap*.deb && cpack > cpack.log) || { cat build/release/cpack.log; exit 1; }
for package in build/release/fleetmap*.deb; do
  echo "$package: $(du -k "$package" | cut -f1) kB, $(dpkg-deb -f "$package" Depends | tr ',' '\n' | wc -l) dependencies"
done
[ "${1:-}" = --test ] || exit 0

command -v debootstrap > /dev/null || { echo "install debootstrap first" >&2; exit 1; }
debian=$(mktemp -d)
chmod 755 "$debian"
trap 'rm -rf "$debian"' EXIT
debootstrap --variant=minbase bookworm "$debian" > "$debian.log" 2>&1 || { tail "$debian.log"; exit 1; }
rm -f "$debian.log"
cp build/release/fleetmap*.deb "$debian/tmp/"
cp -r deploy/ansible "$debian/tmp/ansible"
refuse() {  # MESSAGE COMMAND...: the command must fail
  if "${@:2}" > "$debian/tmp/refused.log" 2>&1; then echo "$1" >&2; exit 1; fi
}
in_debian() { chroot "$debian" env DEBIAN_FRONTEND=noninteractive "$@"; }
in_debian apt-get -qq update
in_debian bash -euc 'cp /tmp/fleetmap_*.deb /tmp/robot.deb; cp /tmp/fleetmap-twin_*.deb /tmp/twin.deb
  cp /tmp/fleetmap-dev_*.deb /tmp/dev.deb; cp /tmp/fleetmap-gis_*.deb /tmp/gis.deb'
install_in_debian() {
  in_debian apt-get install -y -qq --no-install-recommends "$@" > "$debian/tmp/install.log" 2>&1 ||
    { tail -n 20 "$debian/tmp/install.log"; exit 1; }
}
install_in_debian /tmp/robot.deb
echo "installed into a clean Debian 12: $(du -sm --exclude=proc "$debian" | cut -f1) MB with all dependencies"
in_debian getent passwd fleetmap
in_debian fleetmap --version
for absent in libembree3-3 libgdal32 default-jre-headless openjdk-17-jre-headless; do
  refuse "$absent is installed" in_debian dpkg -s "$absent"
done
# A robot simulates nothing and writes no GeoTIFF. The twin says what it lacks, and runs once that is there.
cp -r config/fleets config/worlds config/sensors "$debian/tmp/"
refuse "the twin runs without Embree" in_debian fleetmap run -c /tmp/fleets/farm_small.yaml --agents 1 --out /tmp/none
grep -q 'install the package fleetmap-twin' "$debian/tmp/refused.log"
install_in_debian /tmp/twin.deb
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
geotiff() { in_debian fleetmap map export /tmp/out/r1/store.db --format geotiff --out /tmp/rasters; }
refuse "GeoTIFF is written without GDAL" geotiff
grep -q 'install the package fleetmap-gis' "$debian/tmp/refused.log"
install_in_debian /tmp/gis.deb
geotiff
# All that fleetmap-dev depends on is in Debian; the program is compiled with what this machine has of it.
in_debian apt-get install -s -qq /tmp/dev.deb > /dev/null
dpkg -x "$debian/tmp/dev.deb" "$debian/tmp/dev"
cmake -S deploy/package/example -B "$debian/tmp/example" -DCMAKE_PREFIX_PATH="$debian/tmp/dev/usr" > /dev/null
cmake --build "$debian/tmp/example" > /dev/null
"$debian/tmp/example/nodes_nearby" "$debian/tmp/out/r1/store.db"
# The role installs the package, and refuses a wrong setting by what check-config says.
install_in_debian ansible-core
play() {
  in_debian ansible-playbook -c local -i /tmp/ansible/three_robots.yml /tmp/ansible/fleet.yml --limit "$1" \
    -e ansible_become=false -e fleetmap_package=/tmp/robot.deb "${@:2}" > "$debian/tmp/play.log" 2>&1
}
in_debian fleetmap keys init --dir /tmp/keys
for robot in r1 r2 r3; do in_debian fleetmap keys add "$robot" --dir /tmp/keys > /dev/null; done
play r1 -e fleetmap_keys=/tmp/keys || { cat "$debian/tmp/play.log"; exit 1; }
play r3 -e fleetmap_keys=/tmp/keys || { cat "$debian/tmp/play.log"; exit 1; }
in_debian fleetmap check-config /etc/fleetmap/r1.yaml
in_debian fleetmap check-config /etc/fleetmap/r3.yaml
refuse "a wrong setting is taken" play r1 -e '{"fleetmap_settings": {"lidar": {"modell": "vlp16"}}}'
grep -q "did you mean 'model'" "$debian/tmp/play.log"
# The unit as such is checked by this machine's systemd, which is not among the dependencies.
service=$debian/tmp/fleetmap-agent@r1.service
sed "s#/usr/bin/fleetmap#$root/build/release/bin/fleetmap#" "$debian/usr/lib/systemd/system/fleetmap-agent@.service" > "$service"
systemd-analyze verify --man=no "$service"
systemd-analyze security --offline=yes --threshold=29 "$service" | tail -n 1
install_in_debian systemd-sysv dbus
cp -r "$debian/tmp/recordings/r1" "$debian/srv/drive"  # a boot empties /tmp
./deploy/package/service_test.sh "$debian" /srv/drive
echo "package: ok"
