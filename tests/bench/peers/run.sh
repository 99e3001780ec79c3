#!/usr/bin/env bash
# fleetmap and its peers on the same scans, one process at a time: prints "drive odometry | CPU and peak | errors".
#   run.sh PROJECT_BUILD PEERS_BUILD OUT [ODOMETRY...]     SEEDS="1 2 3 4 5" LENGTH=60 DRIVES="uneven kitti farm_60 ..."
# The trajectories stay in OUT; scans are kept, too (0.7 GB a twin drive of 60 m), so that it can be called again.
set -euo pipefail
build=$1 peers=$2 out=$3
shift 3
odometries=${*:-ours rko kiss genz}
here=$(dirname "$0")
data=${FLEETMAP_SHARED_DATA:?folder that holds uneven_farm_vlp16 and kitti_raw_2011_09_26_drive_0005}
kitti=$data/kitti_raw_2011_09_26_drive_0005
fleetmap=${FLEETMAP:-$build/bin/fleetmap}
drives=" "
for name in ${DRIVES:-uneven kitti farm_60 rolling_60 woodland_60}; do
  case $name in
    uneven | kitti) drives+="$name " ;;
    *) for seed in ${SEEDS:-1 2 3 4 5}; do drives+="$name:$seed "; done ;;
  esac
done

export_scans() { # drive folder
  [ ! -e "$2/done" ] || return 0
  rm -rf "$2"
  mkdir -p "$2"
  case $1 in
    uneven)
      python3 "$data/uneven_farm_vlp16/to_rosbag2.py" "$2/bag" >/dev/null
      cp "$data/uneven_farm_vlp16/truth_base_link.tum" "$2/truth.tum"
      "$build/bin/bench_odometry_scans" "$2/bag" "$2" ;;
    kitti)
      cp "$kitti/derived/lidar_odometry_consensus_tum_10hz_nominal.txt" "$2/truth.tum"
      "$build/bin/bench_odometry_scans" "$kitti" "$2" --model hdl64e ;;
    *) "$build/bin/bench_odometry_scans" "$1" "$2" --length "${LENGTH:-60}" ;;
  esac
  touch "$2/done"
}

evaluate() { # drive name log
  local line
  line=$(grep -o 'CPU.*' "$3" | tail -1 || true)
  echo "$1 $2 | $line | $(python3 "$here/evaluate.py" "$folder/truth.tum" "$folder/$2.tum" | cut -d'|' -f3-) $(tail -1 "$3" | grep lost || true)"
}

ours() { # drive name, settings of the sensors used
  local recording=$folder/bag mount=()
  case $1 in
    uneven) mount=(--set 'lidar.translation=[0,0,0.35]') ;;
    kitti) recording=$kitti mount=(--set lidar.model=hdl64e --set lidar.min_range=2.5) ;;
    *) mount=(--set 'lidar.translation=[0.1,0,0.5]' --set 'lidar.rotation_rpy_deg=[0,1.1459155903,0]'
              --set 'imu.translation=[0,0.1,0.1]' --set 'imu.rotation_rpy_deg=[0,0,28.6478897565]') ;;
  esac
  "$fleetmap" odometry "$recording" --out "$folder/$2.tum" "${mount[@]}" "${@:3}" >"$folder/$2.log" 2>&1 || echo "exit code $?: lost" >>"$folder/$2.log"
  evaluate "$1" "$2" "$folder/$2.log"
}

peer() { # drive name program settings
  local mount=()
  case $1 in
    uneven) mount=(lidar=0,0,0.35,0,0,0) ;;
    kitti) ;;
    *) mount=(lidar=0.1,0,0.5,0,0.02,0 imu_mount=0,0.1,0.1,0,0,0.5) ;;
  esac
  "$peers/$3" "$folder" "$folder/$2.tum" "${mount[@]}" "${@:4}" >"$folder/$2.log" 2>&1
  evaluate "$1" "$2" "$folder/$2.log"
}

# Settings of GenZ-ICP's own files for such drives, de-skewed.
outdoor=(deskew=1 max_range=100 min_range=0.5 voxel_size=0.6 desired_num_voxelized_points=3000 planarity_threshold=0.2
         max_points_per_voxel=3 max_num_iterations=100)
kitti_settings=("${outdoor[@]}" min_range=5 planarity_threshold=0.18)

for odometry in $odometries; do
  for drive in $drives; do
    folder=$out/$drive
    export_scans "$drive" "$folder"
    alone=(--set odometry.use_imu=false --set odometry.use_wheel=false)
    case $odometry in
      ours)
        ours "$drive" fleetmap "${alone[@]}"
        ours "$drive" fleetmap_not_compensated "${alone[@]}" --set odometry.deskew=false
        ours "$drive" fleetmap_imu --set odometry.use_wheel=false
        ours "$drive" fleetmap_wheels --set odometry.use_imu=false
        ours "$drive" fleetmap_both ;;
      rko)
        peer "$drive" rko_lio peer_rko_lio
        peer "$drive" rko_lio_imu peer_rko_lio imu=1 ;;
      kiss)
        peer "$drive" kiss_icp peer_kiss_icp
        case $drive in
          uneven) peer "$drive" kiss_icp_2m peer_kiss_icp voxel_size=2 ;;
          kitti) peer "$drive" kiss_icp_0.5m peer_kiss_icp voxel_size=0.5 ;;
        esac ;;
      genz)
        if [ "$drive" = kitti ]; then
          peer "$drive" genz_icp peer_genz_icp "${kitti_settings[@]}"
        else
          peer "$drive" genz_icp peer_genz_icp "${outdoor[@]}"
        fi ;;
    esac
  done
done
