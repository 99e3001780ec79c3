#!/usr/bin/env bash
# Runs deploy/compose.yaml with Docker or Podman, checks that all robots hear each other and that a medium carries what
# its queue and its relay let through and nothing else, and removes what it made.
#   deploy/compose/test.sh [--engine docker|podman]
#                          [--program FILE]     built on Debian 12; else the image builds it from source (long), or
#                          [--image NAME]       is there already
#                          [--recordings DIR]   also maps DIR/r1, DIR/r2, ... in real time: all stores must become equal
#                          [--agents N]         that map; 4 where not given
# Exits with 0, with 1 if something does not hold, with 77 where there is no container engine.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)

engine=
program=
image=
recordings=
agents=4
usage() { sed -n '4,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
while (($#)); do
  (($# > 1)) || usage
  case $1 in
    --engine) engine=$2 ;;
    --program) program=$(realpath "$2") ;;
    --image) image=$2 ;;
    --recordings) recordings=$(realpath "$2") ;;
    --agents) agents=$2 ;;
    *) usage ;;
  esac
  shift 2
done

# ---- engine and image

runs() { "$@" > /dev/null 2>&1; }
if [[ -z $engine ]]; then
  for engine in docker podman none; do runs "$engine" info && break; done
fi
runs "$engine" info || { echo "skipped: no container engine (docker with a running daemon, or podman)"; exit 77; }
if [[ $engine == docker ]]; then
  for tool in "docker compose" docker-compose none; do runs $tool version && break; done
else
  tool=podman-compose
fi
runs $tool version || { echo "skipped: $engine has no compose"; exit 77; }

project=fleetmap-test-$$
scratch=$(mktemp -d)
compose() { timeout 300 $tool -p "$project" -f "$root/deploy/compose.yaml" "$@"; }
finish() {
  compose down -v > "$scratch/down.log" 2>&1 || cat "$scratch/down.log" >&2
  rm -rf "$scratch"
}
trap finish EXIT
trap 'exit 130' INT TERM

# The network of the host serves to install packages where containers have none.
build() {
  "$engine" build --network host "$@" > "$scratch/build.log" 2>&1 ||
    { tail -n 30 "$scratch/build.log" >&2; exit 1; }
}
export IMAGE=${image:-fleetmap-test}
if [[ -n $image ]]; then
  runs "$engine" image inspect "$image" || { echo "no image $image" >&2; exit 2; }
elif [[ -n $program ]]; then
  build --target runtime -f "$root/deploy/Dockerfile" -t fleetmap-runtime "$root"
  mkdir "$scratch/image"
  cp "$program" "$scratch/image/fleetmap"
  printf 'FROM fleetmap-runtime\nCOPY fleetmap /usr/local/bin/\n' > "$scratch/image/Dockerfile"
  build -f "$scratch/image/Dockerfile" -t fleetmap-test "$scratch/image"
else
  build -f "$root/deploy/Dockerfile" -t fleetmap-test "$root"
fi

# ---- steps

failed=0
check() { # what, condition for (( ))
  local holds=ok
  (($2)) || { holds=FAILED; failed=1; }
  echo "$1: $holds"
}
names() { seq -f 'r%g' "$1"; }
up() { # robots
  compose up -d --no-build radio wifi $(names "$1") > "$scratch/up.log" 2>&1 || { cat "$scratch/up.log" >&2; exit 1; }
}
down() { compose down -v > "$scratch/down.log" 2>&1; }
inside() { local service=$1; shift; compose exec -T "$service" "$@"; }

says() { compose logs "$1" 2>&1 | grep -c "$2" || true; } # robot, pattern
all_hear() { # robots; waits for it
  local begin=$SECONDS robot count
  while :; do
    count=0
    for robot in $(names "$1"); do ((count += $(says "$robot" 'long_range: heard r[0-9]* at'))) || true; done
    ((count < $1 * ($1 - 1) && SECONDS - begin < 30)) || break
    sleep 0.5
  done
  check "$1 robots, heard on the radio after $((SECONDS - begin)) s: $count" "count == $1 * ($1 - 1)"
  ((count == $1 * ($1 - 1))) || compose logs >&2
}

counter() { # robot, NET, rx or tx: bytes on its device
  inside "$1" bash -c ". deploy/compose/addresses.sh; cat /sys/class/net/\$(device_of $2)/statistics/$3_bytes"
}
sum_of() { # NET, rx or tx: of four robots
  local robot sum=0
  for robot in $(names 4); do ((sum += $(counter "$robot" "$1" "$2"))) || true; done
  echo $sum
}
passed() { inside "$1" cat /sys/class/net/out/statistics/tx_bytes; } # medium
field() { sed -n "s/.*\"$2\": \([0-9]*\).*/\1/p" "$scratch/$1.json"; } # receiving robot, key: whole part

# Sends datagrams from robot to robot: probe BEGIN FROM TO NET KBIT
seconds=10
probe() {
  inside "r$3" python3 deploy/compose/probe.py receive "$1" $seconds > "$scratch/r$3.json" &
  local receiver=$!
  inside "r$2" python3 deploy/compose/probe.py send "$1" $seconds "10.$4.$3.2" "$5"
  wait "$receiver"
}
soon() { echo $(($(date +%s) + 3)); }

# Two pairs of robots that share nothing but the medium each offer its whole rate.
flood() { # medium, NET, KBIT
  local before received_before got queued received pairs begin
  before=$(passed "$1") received_before=$(sum_of "$2" rx)
  begin=$(soon)
  probe "$begin" 1 2 "$2" "$3" & pairs=$!
  probe "$begin" 3 4 "$2" "$3"
  wait "$pairs"
  queued=$(($(passed "$1") - before)) received=$(($(sum_of "$2" rx) - received_before))
  got=$(($(field r2 kbit_s) + $(field r4 kbit_s)))
  check "$1, $((2 * $3)) kbit/s offered by two pairs: $(field r2 kbit_s) + $(field r4 kbit_s) kbit/s arrive" \
    "got <= $3 * 102 / 100 && got >= $3 * 80 / 100"
  # Robots also receive ARP, and IPv6 multicast of the devices that were just made.
  check "$1: $queued bytes left its queue, $received reached the robots" \
    "received <= queued * 101 / 100 + 8000 && received >= queued * 98 / 100"
}

# ---- what must hold

up 4
all_hear 4
flood radio 77 200
flood wifi 78 15000
direct=$(for robot in $(names 4); do
    inside "$robot" bash -c 'for to in 10.7{7,8}.{1..4}.2; do ip route get $to; done'
  done |
  grep -cvE '^local|^ *cache|via 10.7[78].250.2' || true)
check "ways from robot to robot that avoid a medium, by route or redirect: $direct" "direct == 0"
down

LOSS=20 DELAY=100 JITTER=200 DUPLICATE=5 up 4
all_hear 4
probe "$(soon)" 1 2 77 100
check "relay with 20 % loss, 100 ms delay, 200 ms jitter, 5 % doubled: $(cat "$scratch/r2.json")" \
  "$(field r2 lost) >= 12 && $(field r2 lost) <= 28 && $(field r2 doubled) >= 1 &&
   $(field r2 overtaken) >= 1 && $(field r2 delay_min) >= 100"
down

if [[ -n $recordings ]]; then
  export RECORDINGS=$recordings AGENTS=$agents OUT=$scratch/out
  mkdir "$OUT"
  begin=$SECONDS
  up "$agents"
  for robot in $(names "$agents"); do
    id=$($engine ps -aq --filter "name=$project.$robot")
    code=$(timeout 400 "$engine" wait "$id") || code=late
    [[ $code == 0 ]] || { failed=1; echo "$robot ended with: $code"; }
  done
  kilobytes() { echo "$1 $(($(passed "$1") / 1000)) kB"; }
  hashes=$(for robot in $(names "$agents"); do
    compose run --rm --no-deps -T --entrypoint fleetmap r1 map info --json "/out/$robot/store.db" 2> /dev/null |
      sed -n 's/.*"hash": "\([0-9a-f]*\)".*/\1/p'
  done)
  different=$(cut -c 1-8 <<< "$hashes" | sort | uniq -c | xargs)
  check "$agents robots mapped for $((SECONDS - begin)) s, $(kilobytes radio), $(kilobytes wifi); stores: $different" \
    "$(wc -l <<< "$hashes") == $agents && $(sort -u <<< "$hashes" | wc -l) == 1 && ${#hashes} > 8"
fi
exit $failed
