#!/usr/bin/env bash
# Cross-builds the Debian packages for arm64 on an amd64 machine: build/arm64/fleetmap*_arm64.deb.
#   deploy/package_arm64.sh
#   deploy/package_arm64.sh --test    also unpacks them with what they depend on into a root of arm64, runs them there under
#                                     QEMU (root), and compares maps of one store with those of this machine's program
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
apt=$root/build/arm64_apt
sysroot=$root/build/arm64_sysroot

./deploy/install-dependencies.sh --arm64
# apt for arm64 with directories of its own: nothing is installed in this machine's root.
mkdir -p "$apt"/{state,cache}
: > "$apt/status"
echo "deb [arch=arm64 signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main" > "$apt/sources.list"
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

unpack() {  # ROOT DEB: with an entry in a database of dpkg, in which dpkg-shlibdeps looks up libraries by their path here
  local database=$1/var/lib/dpkg name info
  name=$(dpkg-deb -f "$2" Package)
  dpkg-deb --fsys-tarfile "$2" | tar -x --keep-directory-symlink -C "$1"
  info=$database/info/$name
  [ "$(dpkg-deb -f "$2" Multi-Arch)" != same ] || info+=:$(dpkg-deb -f "$2" Architecture)
  dpkg-deb --fsys-tarfile "$2" | tar -t | sed -n "s#^\./\(.*[^/]\)\$#$1/\1#p" | sed "s#^$1/lib/#$1/usr/lib/#" > "$info.list"
  dpkg-deb --ctrl-tarfile "$2" | tar -x -C "$database/control"
  for file in symbols shlibs; do
    [ ! -f "$database/control/$file" ] || mv "$database/control/$file" "$info.$file"
  done
  { echo "Status: install ok installed"; cat "$database/control/control"; echo; } >> "$database/status"
  rm -rf "$database/control"/*
}
fill() {  # ROOT PACKAGE...: unpacks packages, with all that they depend on
  local to=$1
  shift
  mkdir -p "$to"/usr/{bin,sbin,lib} "$to"/var/lib/dpkg/{info,control}
  for folder in bin sbin lib; do ln -sfn "usr/$folder" "$to/$folder"; done
  printf 'amd64\narm64\n' > "$to/var/lib/dpkg/arch"
  echo 1 > "$to/var/lib/dpkg/info/format"  # names of files have the architecture
  apt_arm64 install -y -qq --download-only "$@" > /dev/null
  for package in $(apt_arm64 install -s -qq "$@" | grep -v local-deb | sed -n 's/^Inst \([^ ]*\) (\([^ ]*\) .*\[\([a-z0-9]*\)\]).*/\1_\2_\3.deb/p'); do
    unpack "$to" "$apt/cache/archives/${package//:/%3a}"
  done
  for package in "$@"; do
    [[ $package != *.deb ]] || unpack "$to" "$package"
  done
}
development=(
  libc6-dev libstdc++-12-dev libfastrtps-dev libfastcdr-dev libtinyxml2-dev libeigen3-dev libpcl-common1.13 libflann-dev
  libboost-dev libnanoflann-dev libdraco-dev libgeographiclib-dev libsleef-dev libyaml-cpp-dev libcli11-dev libspdlog-dev
  libexpected-dev nlohmann-json3-dev libsqlite3-dev libssl-dev liblzma-dev libzstd-dev liblz4-dev libbz2-dev zlib1g-dev
  libembree-dev libpng-dev libgdal-dev libsystemd-dev
)
if [ ! -f "$sysroot/complete" ]; then
  rm -rf "$sysroot"
  apt_arm64 update -qq
  fill "$sysroot" "${development[@]}"
  # The headers and links of PCL alone: VTK and Qt, on which its package depends, are 2 GB.
  (cd "$apt/cache/archives" && apt_arm64 download -qq libpcl-dev)
  unpack "$sysroot" "$apt"/cache/archives/libpcl-dev_*.deb
  # Links and CMake's files name paths in a root, which is here.
  find "$sysroot" -type l -lname '/*' -printf '%p %l\n' | while read -r link target; do ln -sfn "$sysroot$target" "$link"; done
  find "$sysroot/usr/lib" "$sysroot/usr/share" -name '*.cmake' -exec sed -i -E "s#([\";])/usr([/\"])#\1$sysroot/usr\2#g" {} +
  touch "$sysroot/complete"
fi

cmake --preset arm64 > /dev/null
cmake --build --preset arm64 --target fleetmap
(cd build/arm64 && rm -f fleetmap*.deb && DPKG_ADMINDIR=$sysroot/var/lib/dpkg DEB_HOST_ARCH=arm64 cpack > cpack.log) || { cat build/arm64/cpack.log; exit 1; }
for package in build/arm64/fleetmap*.deb; do
  echo "$package: $(du -k "$package" | cut -f1) kB, $(dpkg-deb -f "$package" Depends | tr ',' '\n' | wc -l) dependencies"
done
[ "${1:-}" = --test ] || exit 0
