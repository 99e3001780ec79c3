#!/usr/bin/env bash
# Cross-builds the Debian packages for arm64 on an amd64 machine: build/arm64/fleetmap*_arm64.deb.
#   deploy/package_arm64.sh
#   deploy/package_arm64.sh --test    also unpacks them with all that they depend on into a root of arm64, runs the program
#                                     there under QEMU (root), and compares maps of one store with those made here
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
apt=$root/build/arm64_apt
sysroot=$root/build/arm64_sysroot

./deploy/install-dependencies.sh --arm64

# apt for arm64 with directories of its own: nothing of it is installed in this machine's root.
mkdir -p "$apt"/{state,cache}
: > "$apt/status"
cat > "$apt/sources.list" <<'LIST'
deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main
LIST
cat > "$apt/apt.conf" <<CONF
APT::Architecture "arm64";
APT::Architectures "arm64";
APT::Install-Recommends "false";
APT::Sandbox::User "root";
Dir::State "$apt/state";
Dir::State::status "$apt/status";
Dir::Cache "$apt/cache";
Dir::Etc::sourcelist "$apt/sources.list";
Dir::Etc::sourceparts "-";
CONF
apt_arm64() { APT_CONFIG=$apt/apt.conf apt-get "$@"; }

# Unpacks a package into a root, with an entry in a database of dpkg that names its files by their paths on this machine:
# dpkg-shlibdeps looks libraries up by these.
unpack() {  # ROOT DEB
  local database=$1/var/lib/dpkg entry file
  entry=$database/info/$(dpkg-deb -f "$2" Package)
  [ "$(dpkg-deb -f "$2" Multi-Arch)" != same ] || entry+=:arm64
  dpkg-deb --fsys-tarfile "$2" | tar -x --keep-directory-symlink -C "$1"
  dpkg-deb --fsys-tarfile "$2" | tar -t | sed -n "s#^\./\(.*[^/]\)\$#/\1#p" | sed "s#^/lib/#/usr/lib/#; s#^#$1#" > "$entry.list"
  rm -rf "$database/control"
  dpkg-deb -e "$2" "$database/control"
  for file in symbols shlibs; do
    [ ! -f "$database/control/$file" ] || mv "$database/control/$file" "$entry.$file"
  done
  { echo "Status: install ok installed"; cat "$database/control/control"; echo; } >> "$database/status"
}

# Makes a root of packages, by name or as files, and all that they depend on. No script of theirs runs.
make_root() {  # ROOT PACKAGE...
  local to=$1 folder package
  shift
  rm -rf "$to"
  mkdir -p "$to"/usr/{bin,sbin,lib} "$to/var/lib/dpkg/info" "$to/tmp"
  for folder in bin sbin lib; do ln -s "usr/$folder" "$to/$folder"; done
  printf 'amd64\narm64\n' > "$to/var/lib/dpkg/arch"
  echo 1 > "$to/var/lib/dpkg/info/format"  # files of the database are named NAME:ARCHITECTURE
  apt_arm64 update -qq
  apt_arm64 install -y -qq --download-only "$@" > /dev/null
  # Inst libc6 (2.36-9+deb12u14 Debian:12.15/oldstable [arm64])
  for package in $(apt_arm64 install -s -qq "$@" | grep -v local-deb |
                   sed -n 's/^Inst \([^ ]*\) (\([^ ]*\) .*\[\([a-z0-9]*\)\]).*/\1_\2_\3.deb/p'); do
    unpack "$to" "$apt/cache/archives/${package//:/%3a}"
  done
  for package in "$@"; do
    [[ $package != *.deb ]] || unpack "$to" "$package"
  done
}

# The same libraries as in install-dependencies.sh. libpcl-dev follows without VTK and Qt, on which it depends (2 GB).
libraries=(
  libc6-dev libstdc++-12-dev
  libfastrtps-dev libfastcdr-dev libtinyxml2-dev
  libeigen3-dev libpcl-common1.13 libflann-dev libnanoflann-dev libdraco-dev libgeographiclib-dev libsleef-dev
  libyaml-cpp-dev libcli11-dev libspdlog-dev libexpected-dev nlohmann-json3-dev
  libsqlite3-dev libssl-dev liblzma-dev libzstd-dev liblz4-dev libbz2-dev zlib1g-dev libembree-dev libpng-dev libgdal-dev libboost-dev libsystemd-dev
)
if [ "$(cat "$sysroot/complete" 2> /dev/null)" != "${libraries[*]}" ]; then
  make_root "$sysroot" "${libraries[@]}"
  (cd "$apt/cache/archives" && rm -f libpcl-dev_*.deb && apt_arm64 download -qq libpcl-dev)
  unpack "$sysroot" "$apt"/cache/archives/libpcl-dev_*.deb
  # Links and CMake's files name paths from the root.
  find "$sysroot" -type l -lname '/*' -printf '%p %l\n' | while read -r link target; do ln -sfn "$sysroot$target" "$link"; done
  find "$sysroot/usr/lib" "$sysroot/usr/share" -name '*.cmake' -exec sed -i -E "s#([\";])/usr([/\"])#\1$sysroot/usr\2#g" {} +
  echo "${libraries[*]}" > "$sysroot/complete"
fi

cmake --preset arm64 > /dev/null
cmake --build --preset arm64 --target fleetmap
(cd build/arm64 && rm -f fleetmap*.deb && DPKG_ADMINDIR=$sysroot/var/lib/dpkg DEB_HOST_ARCH=arm64 cpack > cpack.log) ||
  { cat build/arm64/cpack.log; exit 1; }
for package in build/arm64/fleetmap*.deb; do
  echo "$package: $(du -k "$package" | cut -f1) kB, $(dpkg-deb -f "$package" Depends | tr ',' '\n' | wc -l) dependencies"
done
[ "${1:-}" = --test ] || exit 0

cmake --preset release -DFLEETMAP_UNITY=ON > /dev/null
cmake --build --preset release --target fleetmap
here=$root/build/release/bin/fleetmap
scratch=$(mktemp -d)
chmod 755 "$scratch"
trap 'rm -rf "$scratch"' EXIT
debian=$scratch/debian
tmp=$debian/tmp
arm() { chroot "$debian" /usr/bin/qemu-aarch64-static /usr/bin/fleetmap "$@"; }

for package in "$root"/build/arm64/fleetmap*.deb; do
  [ "$(dpkg-deb -f "$package" Architecture)" = arm64 ] || { echo "$package is not for arm64" >&2; exit 1; }
done
apt_arm64 install -s -qq "$root"/build/arm64/fleetmap*.deb > /dev/null  # all of them can be installed
make_root "$debian" "$root"/build/arm64/fleetmap_*_arm64.deb
echo "a root of arm64: $(du -sm "$debian" | cut -f1) MB with all dependencies"
cp /usr/bin/qemu-aarch64-static "$debian/usr/bin/"
mkdir -p "$debian/dev"
mknod -m 666 "$debian/dev/null" c 1 3
mknod -m 666 "$debian/dev/urandom" c 1 9
arm --version
arm check-config /usr/share/fleetmap/config/agents/r1.yaml

# Fleets of this machine, cut off before all rows are driven: a recording is mapped there, and stores are placed on both.
fleet() {  # NAME SECONDS ARGUMENTS...
  "$here" run -c config/fleets/farm_small.yaml --agents 2 --set "max_time=$2" --record "$tmp/$1/recordings" --out "$tmp/$1/out" \
    "${@:3}" > "$scratch/run.log" 2>&1 || true
  [ -s "$tmp/$1/out/r1/store.db" ] || { tail "$scratch/run.log"; exit 1; }
}
fleet short 20
fleet graph 120
fleet paper 60 --set mode=paper
arm inspect /tmp/short/recordings/r1
arm run --recording r1=/tmp/short/recordings/r1 --recording r2=/tmp/short/recordings/r2 --out /tmp/mapped
test -s "$tmp/mapped/r1/map.ply"

differs=0
compare() {  # STORE FILE SUBCOMMAND: what `fleetmap map SUBCOMMAND STORE --out FILE` writes
  mkdir -p "$tmp/there" "$tmp/here"
  arm map "$3" "/tmp/$1" --out "/tmp/there/$2" > "$scratch/map.log" || { cat "$scratch/map.log"; exit 1; }
  "$here" map "$3" "$tmp/$1" --out "$tmp/here/$2" > "$scratch/map.log" || { cat "$scratch/map.log"; exit 1; }
  if cmp -s "$tmp/there/$2" "$tmp/here/$2"; then
    echo "$1, $2: the same $(stat -c %s "$tmp/here/$2") bytes"
  elif [[ $2 == *.las ]] && python3 deploy/package/las_units.py "$tmp/there/$2" "$tmp/here/$2" > "$scratch/las.log"; then
    echo "$1, $2: $(cat "$scratch/las.log")"
  else
    cmp "$tmp/there/$2" "$tmp/here/$2" || true
    cat "$scratch/las.log" 2> /dev/null || true
    differs=1
  fi
}
for store in graph/out/r1/store.db paper/out/r1/store.db mapped/r1/store.db; do
  compare "$store" map.ply export
  compare "$store" map.las export
  compare "$store" graph.g2o graph
  compare "$store" tracks.geojson tracks
done
[ "$differs" = 0 ] && echo "package of arm64: ok"
exit "$differs"
