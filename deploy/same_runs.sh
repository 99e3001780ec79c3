#!/usr/bin/env bash
# Five short runs in virtual time by two builds of the program: what a change that should change nothing must leave as it is.
# Compares maps, trajectories, tables and the hash of each store's set; exit code 1 if anything differs.
#   deploy/same_runs.sh BEFORE [AFTER]     programs; AFTER: build/release/bin/fleetmap
set -euo pipefail
(($# >= 1)) || { sed -n '2,4s/^# \{0,1\}//p' "$0" >&2; exit 2; }
before=$(realpath "$1")
cd "$(dirname "$0")/.."
after=$(realpath "${2:-build/release/bin/fleetmap}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Name, then arguments of `fleetmap run`. Between them: farms, a wood, no GPS, other LiDARs, the paper's method, loss.
runs() {
  cat <<'RUNS'
farm            -c config/fleets/farm_small.yaml --agents 3 --set max_time=100
wood            -c config/fleets/farm_small.yaml --agents 2 --set max_time=60 --set world.file=../worlds/woodland_60.yaml --set world.seed=2
mixed_team      -c config/fleets/mixed_team.yaml --set max_time=60
paper           -c config/fleets/farm_small.yaml --agents 2 --set max_time=60 --set mode=paper
without_imu     -c config/fleets/farm_small.yaml --agents 2 --set max_time=60 --set odometry.use_imu=false --set network.long_range.loss=0.2
RUNS
}
# Hash and name of each file that a run left, but for reports and registrations.csv, which hold times.
hashes() { # PROGRAM FOLDER
  local robot
  (cd "$2" && find . -type f \( -name '*.ply' -o -name '*.pcd' -o -name '*.tum' -o -name '*.csv' \) ! -name registrations.csv -print0 |
    sort -z | xargs -0 sha256sum)
  for robot in "$2"/r*/; do
    echo "$("$1" map info --json "$robot/store.db" | sed -n 's/^  "hash": "\(.*\)",*/\1/p')  $(basename "$robot")/store.db"
  done
}

differs=0
while read -r name arguments; do
  for which in before after; do
    # shellcheck disable=SC2086 # arguments are words
    "${!which}" run $arguments --out "$scratch/$which" >"$scratch/$which.log" 2>&1 || { tail "$scratch/$which.log"; echo "$name: $which failed"; exit 1; }
    hashes "${!which}" "$scratch/$which" >"$scratch/$which.sums"
    rm -rf "${scratch:?}/$which"
  done
  if cmp -s "$scratch/before.sums" "$scratch/after.sums"; then
    echo "$name: the same $(wc -l <"$scratch/after.sums") files, $(sha256sum <"$scratch/after.sums" | cut -c1-16)"
  else
    echo "$name: differs"
    diff "$scratch/before.sums" "$scratch/after.sums" | sed 's/^/  /' || true
    differs=1
  fi
done < <(runs)
exit $differs
