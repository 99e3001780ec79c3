#!/usr/bin/env bash
# Installs what is missing, builds, and lets three robots map a solar farm of 200 m x 200 m in the digital twin: the twin
# and each robot's agent are processes of their own that talk over DDS, in real time, for about four minutes. The robots
# plan on a drawing of the site, not on the twin's world. Ends with the plan, the merged map, the report and pictures of the
# map in one folder, and with the command that shows them in a browser; exit code 1 if rows were not driven, or the
# robots' maps are not of the same nodes and submaps.
#   deploy/demo.sh [OUT]     OUT: folder of the results, default out/demo
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/../out/demo}")
cd "$(dirname "$0")/.."
fleet=config/fleets/demo.yaml
site=config/sites/farm_200.geojson  # the drawing that the fleet plans on
robots=(r1 r2 r3)
limit=270  # s; a robot that is not done by then is told to end

./deploy/install-dependencies.sh
log=$(mktemp)
pids=()
cleanup() {
  [ "${#pids[@]}" -eq 0 ] || kill "${pids[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -f "$log"
}
trap cleanup EXIT
echo "building (the first time takes some minutes)"
cmake --preset release -DFLEETMAP_UNITY=ON >"$log" 2>&1 || { cat "$log"; exit 1; }
cmake --build --preset release --target fleetmap
fleetmap=build/release/bin/fleetmap

# Only what an earlier demo left goes.
if [ -e "$out/.fleetmap-demo" ]; then
  rm -rf "${out:?}"/r[0-9]* "$out"/*.json "$out"/*.html "$out"/*.png "$out"/*.ply "$out"/*.log "$out"/*.geojson
elif [ -e "$out/r1" ]; then
  echo "$out holds something that is not an earlier demo's; name another folder" >&2
  exit 2
fi
mkdir -p "$out"
touch "$out/.fleetmap-demo"

"$fleetmap" plan "$site" -c "$fleet" --out "$out/plan.geojson"
"$fleetmap" sim -c "$fleet" --out "$out" >"$out/sim.log" 2>&1 &
sim=$!
pids+=("$sim")
agents=()
for robot in "${robots[@]}"; do
  "$fleetmap" agent -c "$fleet" --as "$robot" --out "$out" --exit-after-idle 5 >"$out/$robot.log" 2>&1 &
  agents+=("$!")
  pids+=("$!")
done
echo "three robots drive; every 10 s a line of each (all of it: $out/*.log)"

running() {
  for pid in "${agents[@]}"; do kill -0 "$pid" 2>/dev/null && return 0; done
  return 1
}
begin=$SECONDS
while running; do
  kill -0 "$sim" 2>/dev/null || { echo "the twin has stopped:" >&2; tail -n 5 "$out/sim.log" >&2; exit 1; }
  if [ $((SECONDS - begin)) -ge "$limit" ]; then
    echo "time is up: the robots end with what they have"
    kill -TERM "${agents[@]}" 2>/dev/null || true
    break
  fi
  sleep 10
  echo "-- $((SECONDS - begin)) s"
  for robot in "${robots[@]}"; do grep -h "rows driven\|scans," "$out/$robot.log" | tail -n 2 || true; done
done
failed=0
for pid in "${agents[@]}"; do wait "$pid" || failed=1; done
kill -INT "$sim" 2>/dev/null || true
wait "$sim" || failed=1
pids=()
[ "$failed" -eq 0 ] || { echo "a process failed:" >&2; tail -n 3 "$out"/*.log >&2; exit 1; }
"$fleetmap" eval "$out"

# Each robot's last line on the mission, and the content of its store.
good=1
echo
for robot in "${robots[@]}"; do
  said=$(sed -n 's/.* \([0-9]* of [0-9]*\) rows driven by the fleet.*/\1/p' "$out/$robot.log" | tail -n 1)
  [ -n "$said" ] && [ "${said% of *}" = "${said#* of }" ] || good=0
  set_hash=$("$fleetmap" map info --json "$out/$robot/store.db" | sed -n 's/^  "hash": "\(.*\)",*/\1/p')
  [ -n "$set_hash" ] && [ "$set_hash" = "${first_hash:=$set_hash}" ] || good=0
  echo "$robot:                ${said:-no} rows driven, nodes and submaps held: ${set_hash:0:16}"
done

echo "plan:              $out/plan.geojson $out/plan.png"
echo "map of each robot: $out/{r1,r2,r3}/map.ply (ENU, metres; open with CloudCompare, MeshLab or pcl_viewer)"
echo "pictures:          $out/map_top.png $out/map_perspective.png (coloured by robot)"
echo "report:            $out/{r1,r2,r3}/report.html of each robot (numbers: report.json), and $out/evaluation.html of the fleet"
[ "$good" -eq 1 ] || echo "not all rows were driven, or the maps differ (a machine too slow for four processes in real time? see $out/*.log)" >&2
printf 'look at it:        %q monitor --run %q\n' "$PWD/$fleetmap" "$out"
[ "$good" -eq 1 ]
