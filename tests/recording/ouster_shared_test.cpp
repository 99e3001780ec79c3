// Packets of real Ouster LiDARs against the vendor's digests: MD5 of each field that its own software
// decodes.
#include <gmock/gmock.h>
#include <openssl/evp.h>

#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bag_samples.hpp"
#include "fleetmap/sensor/ouster_packet.hpp"
#include "pcap_file.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;
using namespace recording::testing;

/// Values of a numpy array, as its bytes lie in memory.
template <class T>
void append(Bytes& bytes, T value) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}

std::string md5(const Bytes& bytes) {
  std::uint8_t digest[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  EXPECT_EQ(EVP_Digest(bytes.data(), bytes.size(), digest, &size, EVP_md5(), nullptr), 1);
  std::string text;
  for (unsigned k = 0; k < size; ++k) {
    constexpr char kDigits[] = "0123456789abcdef";
    text += {kDigits[digest[k] >> 4], kDigits[digest[k] & 15]};
  }
  return text;
}

/// Fields of all packets as the program decodes them, in the order of the vendor's arrays.
struct Decoded {
  std::map<std::string, Bytes> packets;            ///< of each packet: columns, or beams by columns
  std::vector<std::vector<std::uint32_t>> ranges;  ///< of the turn: by beam and column
  std::vector<Bytes> reflectivities;
};

Decoded decode_all(const fs::path& capture, const sensor::OusterMetadata& metadata) {
  Decoded out;
  out.ranges.assign(metadata.beams.size(), std::vector<std::uint32_t>(metadata.columns_per_frame));
  out.reflectivities.assign(metadata.beams.size(), Bytes(metadata.columns_per_frame));
  auto file = PcapFile::open(capture);
  EXPECT_TRUE(file);
  while (true) {
    const auto datagram = file->next();
    if (!datagram || !*datagram) return out;
    const auto packet = sensor::read_ouster_packet((*datagram)->payload, metadata);
    if (!packet) continue;
    for (const sensor::OusterColumn& column : packet->columns) {
      append(out.packets["TIMESTAMP"], column.time);
      append(out.packets["MEASUREMENT_ID"], static_cast<std::uint16_t>(column.measurement));
      append(out.packets["FRAME_ID"], static_cast<std::uint16_t>(packet->frame));
    }
    for (std::size_t beam = 0; beam < metadata.beams.size(); ++beam) {
      for (const sensor::OusterColumn& column : packet->columns) {
        const std::size_t size = metadata.profile.pixel;
        const auto one = metadata.profile.last_return(column.pixels.subspan(beam * size, size));
        append(out.packets["RANGE"], one.range);
        append(out.packets["REFLECTIVITY"], one.reflectivity);
        out.ranges[beam][column.measurement] = one.range;
        out.reflectivities[beam][column.measurement] = one.reflectivity;
      }
    }
  }
}

TEST(OusterSharedData, FieldsOfAnOs1With32BeamsHaveTheVendorsDigests) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/ouster");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  const auto metadata = sensor::load_ouster_metadata(*data / "OS-1-32-G_v2.1.1_1024x10.json");
  ASSERT_TRUE(metadata) << metadata.error().message;
  const Decoded decoded = decode_all(*data / "OS-1-32-G_v2.1.1_1024x10.pcap", *metadata);
  std::ifstream in(*data / "OS-1-32-G_v2.1.1_1024x10_digest.json");
  const auto digests = nlohmann::json::parse(in);
  ASSERT_EQ(decoded.packets.size(), 5u);
  for (const auto& [field, bytes] : decoded.packets)
    EXPECT_EQ(md5(bytes), digests["packet_hash"][field].get<std::string>()) << field;
  Bytes ranges, reflectivities;
  for (const auto& beam : decoded.ranges)
    for (const std::uint32_t range : beam) append(ranges, range);
  for (const Bytes& beam : decoded.reflectivities)
    reflectivities.insert(reflectivities.end(), beam.begin(), beam.end());
  EXPECT_EQ(md5(ranges), digests["scans"][0]["RANGE"].get<std::string>());
  EXPECT_EQ(md5(reflectivities), digests["scans"][0]["REFLECTIVITY"].get<std::string>());
}

TEST(OusterSharedData, CapturesAreReadAsScansAndImu) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/ouster");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  struct Capture {
    const char *name, *metadata;
    std::size_t scans, least_points, imus;
  };
  for (const auto& [name, file, scans, least_points, imus] :
       {Capture{"OS-1-32-G_v2.1.1_1024x10.pcap", "OS-1-32-G_v2.1.1_1024x10.json", 1, 15'000, 0},
        Capture{"OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "OS-1-128_v2.3.0_1024x10.json", 3, 60'000, 30}}) {
    ReaderConfig config;
    config.ouster_metadata = sensor::load_ouster_metadata(*data / file).value();
    auto reader = open(*data / name, config);
    ASSERT_TRUE(reader) << reader.error().message;
    std::size_t found = 0, samples = 0;
    for (const Sample& sample : read_all(**reader)) {
      if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
        ++samples;
        EXPECT_NEAR(imu->specific_force.norm(), 9.81, 2.0) << "m/s^2";
        EXPECT_LT(imu->angular_velocity.norm(), 1.0) << "rad/s";
        continue;
      }
      const auto& scan = std::get<sensor::Scan>(sample);
      ++found;
      EXPECT_GT(scan.points.size(), least_points) << name;
      EXPECT_NEAR(to_seconds(sensor::sweep_of(scan)), 0.1, 1e-3) << name;
    }
    EXPECT_EQ(found, scans) << name;
    EXPECT_NEAR(static_cast<double>(samples), static_cast<double>(imus), 3.0) << name;
    EXPECT_EQ((*reader)->counters().packets_of_wrong_size, 0u);
    EXPECT_EQ((*reader)->counters().packets_of_wrong_blocks, 0u);
  }
}

/// Eight packets of the beginning of a turn.
TEST(OusterSharedData, PacketsForFunctionalSafetyAreDecoded) {
  const auto data = fleetmap::testing::shared_data("sensor_packets/ouster");
  if (!data) GTEST_SKIP() << "sensor_packets is not installed";
  const std::string name = "OS-1-128_767798045_1024x10_20230712_120049";
  const auto metadata = sensor::load_ouster_metadata(*data / (name + ".json"));
  ASSERT_TRUE(metadata) << metadata.error().message;
  EXPECT_EQ(metadata->profile.name, "FUSA_RNG15_RFL8_NIR8_DUAL");
  auto file = PcapFile::open(*data / (name + ".pcap"));
  ASSERT_TRUE(file);
  std::size_t packets = 0, imus = 0, next_column = 0;
  std::vector<sensor::ScanPoint> points;
  while (true) {
    const auto datagram = file->next();
    if (!datagram || !*datagram) break;
    if ((*datagram)->port == metadata->imu_port) {
      const auto imu = sensor::read_ouster_imu((*datagram)->payload, *metadata);
      ASSERT_TRUE(imu) << imu.error().what;
      EXPECT_NEAR(imu->sample.specific_force.norm(), 9.81, 1.0);
      ++imus;
      continue;
    }
    const auto packet = sensor::read_ouster_packet((*datagram)->payload, *metadata);
    ASSERT_TRUE(packet) << packet.error().what;
    EXPECT_EQ(packet->frame, 229u);
    for (const sensor::OusterColumn& column : packet->columns) {
      if (packets > 0) {
        EXPECT_EQ(column.measurement, next_column);
      }
      next_column = column.measurement + 1;
      append_points(*metadata, column, 0.0, points);
    }
    ++packets;
  }
  EXPECT_EQ(packets, 8u);
  EXPECT_EQ(imus, 2u);
  EXPECT_GT(points.size(), 1'000u);
  for (const sensor::ScanPoint& point : points) EXPECT_LT(point.position.norm(), 262.2f);
}

}  // namespace
}  // namespace fleetmap::recording
