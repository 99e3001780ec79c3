#!/usr/bin/env bash
# Start-up of fleets on plain DDS with and without DDS Security over one radio of 200 kbit/s (root): the table in
# docs/journal/trust_2026_11.md. cmake --build build/release --target bench_dds_security
#   tests/bench/dds_security.sh [SECONDS [ROBOTS...]]    60 s each; 2 3 5 10 robots
# open: no security; rtps: whole packets under one key a participant; payload: payloads under one key a writer, and
# protected discovery, as ROS 2's governance has it.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$root/deploy/netns/medium.sh"
program=${PROGRAM:-$root/build/release/bin/bench_dds_security}
patience=${1:-60}
shift $(($# > 0 ? 1 : 0))
fleets=(${@:-2 3 5 10})
scratch=$(mktemp -d)
trap 'remove_spaces; rm -rf "$scratch"' EXIT

sign() { openssl smime -sign -in "$1" -text -out "$2" -signer "$scratch/ca.pem" -inkey "$scratch/ca.key"; }
issue() { # name, folder
  openssl ecparam -name prime256v1 -genkey -noout -out "$2/key.pem"
  openssl req -new -key "$2/key.pem" -subj "/CN=$1" |
    openssl x509 -req -CA "$scratch/ca.pem" -CAkey "$scratch/ca.key" -CAcreateserial -days 30 \
      -out "$2/cert.pem" 2> /dev/null
}
governance() { # protection of packets, of discovery, of payloads
  cat << XML
<?xml version="1.0" encoding="UTF-8"?>
<dds><domain_access_rules><domain_rule>
  <domains><id>1</id></domains>
  <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
  <enable_join_access_control>true</enable_join_access_control>
  <discovery_protection_kind>$2</discovery_protection_kind>
  <liveliness_protection_kind>$2</liveliness_protection_kind>
  <rtps_protection_kind>$1</rtps_protection_kind>
  <topic_access_rules><topic_rule>
    <topic_expression>*</topic_expression>
    <enable_discovery_protection>$([[ $2 == NONE ]] && echo false || echo true)</enable_discovery_protection>
    <enable_liveliness_protection>false</enable_liveliness_protection>
    <enable_read_access_control>true</enable_read_access_control>
    <enable_write_access_control>true</enable_write_access_control>
    <metadata_protection_kind>NONE</metadata_protection_kind>
    <data_protection_kind>$3</data_protection_kind>
  </topic_rule></topic_access_rules>
</domain_rule></domain_access_rules></dds>
XML
}
permissions() { # name
  cat << XML
<?xml version="1.0" encoding="UTF-8"?>
<dds><permissions><grant name="$1">
  <subject_name>CN=$1</subject_name>
  <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2040-01-01T00:00:00</not_after></validity>
  <allow_rule>
    <domains><id>1</id></domains>
    <publish><topics><topic>fleetmap/*</topic></topics></publish>
    <subscribe><topics><topic>fleetmap/*</topic></topics></subscribe>
  </allow_rule>
  <default>DENY</default>
</grant></permissions></dds>
XML
}
make_security() { # folder of the security, governance...; for ten robots
  local i folder
  for ((i = 1; i <= 10; ++i)); do
    folder=$scratch/$1/r$i
    mkdir -p "$folder"
    cp "$scratch/ca.pem" "$folder"
    issue "r$i" "$folder"
    governance "${@:2}" > "$folder/governance.xml"
    permissions "r$i" > "$folder/permissions.xml"
    sign "$folder/governance.xml" "$folder/governance.smime"
    sign "$folder/permissions.xml" "$folder/permissions.smime"
  done
}
static_endpoints() { # robots; as the program numbers them
  local i id name
  echo '<staticdiscovery>'
  for ((i = 1; i <= $1; ++i)); do
    echo "<participant><name>r$i</name>"
    id=0
    for name in node alignment digest status mission_report hold proximity_match cloud_request item_request \
      cloud_fragment; do
      for kind in writer reader; do
        echo "<$kind><userId>$((++id))</userId><entityID>$id</entityID><topicName>fleetmap/$name</topicName>" \
          "<topicDataType>Empty</topicDataType><topicKind>NO_KEY</topicKind>" \
          "<reliabilityQos>BEST_EFFORT_RELIABILITY_QOS</reliabilityQos></$kind>"
      done
    done
    echo '</participant>'
  done
  echo '</staticdiscovery>'
}

run_case() { # robots, simple|static, open|SECURITY
  local robots=$1 discovery=$2 security=$3 endpoints=$((20 * $1 * ($1 - 1)))
  local i one began before second left slowest= bytes last=0 count=0 full=0 worst=0
  SPACES=()
  for ((i = 1; i <= robots; ++i)); do make_space "robot$i"; done
  medium radio 77 200 30000 "$robots"
  for ((i = 1; i <= robots; ++i)); do
    seq 1 "$robots" | grep -vx "$i" | sed 's/.*/10.77.&.2/' > "$scratch/peers$i"
    static_endpoints "$robots" > "$scratch/peers$i.xml"
  done
  before=$(passed radio)
  for ((i = 1; i <= robots; ++i)); do
    (exec ip netns exec "$(space "robot$i")" "$program" "r$i" "$robots" "$discovery" "$scratch/peers$i" \
      $([[ $security == open ]] || echo "$scratch/$security/r$i") > "$scratch/r$i.out" 2> "$scratch/r$i.err") &
  done
  began=${EPOCHREALTIME/./}
  bytes=$before
  for ((second = 1; second <= patience; ++second)); do
    left=$((began + second * 1000000 - ${EPOCHREALTIME/./}))
    ((left <= 0)) || sleep "$((left / 1000000)).$(printf %06d $((left % 1000000)))"
    last=$bytes
    bytes=$(passed radio)
    ((bytes - last <= worst)) || worst=$((bytes - last))
    ((full > 0)) || (($(cat "$scratch"/r*.out | grep -c matched) < robots)) || full=$bytes
  done
  for ((i = 1; i <= robots; ++i)); do
    for pid in $(ip netns pids "$(space "robot$i")"); do kill -TERM "$pid"; done
  done
  wait
  for one in $(cat "$scratch"/r*.out | sed -n 's/^in all \([-0-9]*\).*/\1/p'); do count=$((count + one)); done
  (($(cat "$scratch"/r*.out | grep -c matched) < robots)) ||
    slowest=$(cat "$scratch"/r*.out | sed -n 's/^matched //p' | sort -n | tail -n 1)
  echo "| $robots | $discovery, $security | ${slowest:-not in $patience} s | $((100 * count / endpoints)) % |" \
    "$( ((full > 0)) && echo $(((full - before) / 1000)) || echo -) | $(((bytes - before) / 1000)) |" \
    "$((worst * 8 / 1000)) | $(dropped radio) |"
  [[ ! -s $scratch/r1.err ]] || sed 's/^/    /' "$scratch/r1.err" | sort | uniq -c | sort -rn | head -3 >&2
  rm -f "$scratch"/r*.out "$scratch"/r*.err
  remove_spaces
}

openssl ecparam -name prime256v1 -genkey -noout -out "$scratch/ca.key"
openssl req -x509 -new -key "$scratch/ca.key" -subj "/CN=fleet" -days 30 -out "$scratch/ca.pem"
make_security rtps ENCRYPT NONE NONE
make_security payload NONE ENCRYPT ENCRYPT
echo "| robots | discovery, security | all matched after | matched at the end | kB until then | kB in $patience s |" \
  "worst second kbit/s | dropped packets |"
echo "|---|---|---|---|---|---|---|---|"
for robots in "${fleets[@]}"; do
  for case in ${CASES:-simple,open simple,rtps simple,payload static,open static,rtps static,payload}; do
    run_case "$robots" "${case%,*}" "${case#*,}"
  done
done
