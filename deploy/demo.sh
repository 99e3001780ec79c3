#!/usr/bin/env bash
# Installs what is missing, builds, and lets two robots make one map: from the real drive if the recordings are beside
# the checkout (or FLEETMAP_SHARED_DATA names them), else from a small generated recording. Ends with where the maps
# and the report are.
#   deploy/demo.sh [OUT]     OUT: folder of the results, default out/demo
set -euo pipefail
out=$(realpath -m "${1:-$(dirname "$0")/../out/demo}")
cd "$(dirname "$0")/.."

./deploy/install-dependencies.sh
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "building (the first time takes some minutes)"
cmake --preset release >"$log" 2>&1 || { cat "$log"; exit 1; }
cmake --build --preset release --target fleetmap make_recording

# Only what an earlier demo left goes.
if [ -e "$out/.fleetmap-demo" ]; then
  rm -rf "$out/r1" "$out/r2" "$out/recordings" "$out/report.json" "$out/report.html"
elif [ -e "$out/r1" ] || [ -e "$out/r2" ]; then
  echo "$out holds something that is not an earlier demo's; name another folder" >&2
  exit 2
fi
mkdir -p "$out"
touch "$out/.fleetmap-demo"
recordings=${FLEETMAP_SHARED_DATA:-../shared/data}
drive=$recordings/kitti_raw_2011_09_26_drive_0005
fleetmap=build/release/bin/fleetmap
if [ -d "$drive" ]; then
  echo "two halves of a real drive (HDL-64E LiDAR, GPS made 1.5 m bad) as two robots"
  "$fleetmap" run -c config/fleets/kitti_0005.yaml --set "recording.path=$(realpath "$drive")" --out "$out"
else
  echo "a generated recording: two robots with VLP-16 that meet in a yard"
  build/release/bin/make_recording "$out/recordings"
  "$fleetmap" run --recording "r1=$out/recordings/r1" --recording "r2=$out/recordings/r2" \
    --set 'lidar.translation=[0,0,0.8]' --set nodes.spacing=4 --out "$out"
fi
echo
echo "map of each robot: $out/r1/map.ply $out/r2/map.ply (ENU, metres; open with CloudCompare, MeshLab or pcl_viewer)"
echo "report:            $out/report.html, $out/report.json"
