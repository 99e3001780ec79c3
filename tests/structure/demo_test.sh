#!/usr/bin/env bash
# Runs a copy of deploy/demo.sh with stand-ins for the program, cmake and sleep: its last line is the command that opens
# the page, also where rows were left, and in a folder whose name has a space.
#   demo_test.sh SOURCE_FOLDER
set -euo pipefail
source=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tree="$folder/a tree"
out="$folder/an out"
mkdir -p "$tree/deploy" "$tree/build/release/bin" "$tree/config" "$folder/bin"
cp "$source/deploy/demo.sh" "$tree/deploy/"
printf '#!/bin/sh\n' | tee "$tree/deploy/install-dependencies.sh" "$folder/bin/cmake" >"$folder/bin/sleep"
cat >"$tree/build/release/bin/fleetmap" <<'STAND_IN'
#!/usr/bin/env bash
case "$1" in
  sim) exec perl -e '$SIG{INT} = sub { exit 0 }; open(F, ">", $ENV{HEARS}); sleep 1 while 1' ;;
  # A twin that does not listen yet would miss its end: shells let what runs in the background ignore SIGINT.
  agent) until [ -e "$HEARS" ]; do :; done; echo "$5: $ROWS rows driven by the fleet" ;;
  map) echo '  "hash": "0123456789abcdef0123456789abcdef",' ;;
esac
STAND_IN
chmod +x "$tree/deploy/install-dependencies.sh" "$folder/bin/"* "$tree/build/release/bin/fleetmap"

# expect ROWS CODE: the demo of robots that say they drove ROWS ends with CODE.
expect() {
  local code=0 last
  rm -f "$folder/hears"
  HEARS="$folder/hears" ROWS=$1 PATH="$folder/bin:$PATH" "$tree/deploy/demo.sh" "$out" >"$folder/said" 2>&1 || code=$?
  last=$(tail -n 1 "$folder/said")
  [ "$code" -eq "$2" ] || { echo "exit code $code instead of $2:"; cat "$folder/said"; exit 1; }
  [[ "$last" == "look at it: "* ]] || { echo "the last line does not open the page: $last"; exit 1; }
  # It is a command that can be pasted.
  eval "set -- ${last#look at it:}"
  [ "$*" = "$tree/build/release/bin/fleetmap monitor --run $out" ] || { echo "no command: $*"; exit 1; }
}
expect "4 of 4" 0
expect "3 of 4" 1
echo passed
