// Writes valid inputs of the binary formats into a folder of corpora: make_fuzz_seeds tests/fuzz/corpus
// Inputs of the formats of text are written by hand.
#include <lzma.h>
#include <sqlite3.h>

#include <cstring>
#include <fstream>
#include <iostream>
#include <random>

#include "bus/dds/hello.hpp"
#include "checks.hpp"
#include "fixed_keys.hpp"
#include "fleet_codec/random_messages.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "fleetmap/ros_codec/velodyne_scan.hpp"
#include "fleetmap/store/store.hpp"
#include "fleetmap/trust/introduction.hpp"
#include "monitor/preview_file.hpp"
#include "recording/pcap_bytes.hpp"
#include "store/item_codec.hpp"
#include "store/items.hpp"
#include "support/livox_message.hpp"
#include "support/ouster_packets.hpp"
#include "support/velodyne_packets.hpp"
#include "trust/key_files.hpp"

namespace fleetmap::fuzz {
namespace {

namespace fs = std::filesystem;

class Seeds {
 public:
  Seeds(const fs::path& corpus, const std::string& target) : folder_(corpus / target) {
    fs::create_directories(folder_);
  }
  void add(const std::string& name, ByteView bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << text_of(bytes);
  }
  /// Behind a first byte that chooses.
  void add(const std::string& name, std::size_t choice, ByteView bytes) const {
    Bytes input{static_cast<std::uint8_t>(choice)};
    input.insert(input.end(), bytes.begin(), bytes.end());
    add(name, input);
  }
  void add(const std::string& name, std::size_t choice, const std::string& text) const {
    add(name, choice, ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  }

 private:
  fs::path folder_;
};

sensor::Scan small_scan() {
  sensor::Scan scan;
  scan.stamp = kNow;
  scan.has_time = scan.has_ring = true;
  for (int k = 0; k < 4; ++k)
    scan.points.push_back(
        {{1.0f + static_cast<float>(k), 2.0f, 0.5f}, 7.0f, 0.01f, static_cast<std::uint16_t>(k)});
  return scan;
}

sensor::Imu small_imu() {
  sensor::Imu imu;
  imu.stamp = kNow;
  imu.specific_force.z() = 9.81;
  return imu;
}

sensor::Fix small_fix() {
  sensor::Fix fix;
  fix.stamp = kNow;
  fix.position = geo_point_from_degrees(49.0, 8.4, 110.0);
  return fix;
}

void fleet_messages(const fs::path& corpus) {
  const Seeds seeds(corpus, "fleet_messages");
  fleet_codec::testing::RandomMessages random(1);
  for (const messages::Message& message : random.one_of_each())
    seeds.add("message_" + std::to_string(message.index()), message.index(), fleet_codec::encode(message));
  constexpr std::size_t kMessages = std::variant_size_v<messages::Message>;
  seeds.add("global_pose", kMessages, fleet_codec::encode(random.global_pose()));
  seeds.add("spherized_cloud", kMessages + 1, fleet_codec::encode(random.cloud()));
}

void ros_messages(const fs::path& corpus) {
  const Seeds seeds(corpus, "ros_messages");
  seeds.add("point_cloud2", 0, ros_codec::encode(small_scan()));
  seeds.add("imu", 1, ros_codec::encode(small_imu()));
  seeds.add("fix", 2, ros_codec::encode(small_fix()));
  seeds.add("wheel", 3, ros_codec::encode(sensor::Wheel{kNow, 1.0, 0.1}));
  seeds.add("battery", 4, ros_codec::encode(sensor::Battery{}));
  seeds.add("odometry", 5, ros_codec::encode(ros_codec::OdometryMsg{.stamp = kNow}));
  testing::LivoxMessage livox{.stamp = 1'700'000'000'000'000'000, .timebase = 1'700'000'000'000'000'000};
  for (std::uint8_t k = 0; k < 8; ++k)
    livox.points.push_back({.offset_time = k * 1'000u, .tag = k, .line = k});
  seeds.add("livox_points", 8, livox.cdr());
  seeds.add("velocity", 6, ros_codec::encode(ros_codec::VelocityCommand{1.0, 0.1}));
}

/// Small clouds, and as many points as 25 kB may claim, which a sender of ours would not encode.
void encoded_clouds(const fs::path& corpus) {
  const Seeds seeds(corpus, "encoded_cloud");
  const auto add = [&](const std::string& name, const cloud::PointCloud& cloud, bool filled) {
    const Bytes bytes = cloud::encode(cloud, {.resolution_m = 0.05}).value();
    seeds.add(name, (filled ? 0u : 254u) + bytes[3], ByteView(bytes).subspan(8));
  };
  const auto many_times = [&](const std::string& name, const cloud::PointCloud& cloud) {
    Bytes bytes = cloud::encode(cloud, {.resolution_m = 0.05}).value();
    constexpr std::uint32_t kClaimed = 200'000;
    std::memcpy(bytes.data() + 8, &kClaimed, sizeof kClaimed);
    seeds.add(name, bytes[3], ByteView(bytes).subspan(8));
  };
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> metres(-20.0f, 20.0f);
  cloud::PointCloud cloud;
  for (int k = 0; k < 50; ++k) cloud.points.emplace_back(metres(engine), metres(engine), metres(engine));
  add("fifty_points", cloud, false);
  cloud.intensities.assign(cloud.points.size(), 3.0f);
  add("fifty_points_with_intensities", cloud, false);
  cloud::PointCloud many;
  many.points.assign(65'000, Eigen::Vector3f(1.0f, 2.0f, 3.0f));
  many_times("one_place_200000_times", many);
  many.intensities.assign(many.points.size(), 1.0f);
  many_times("one_place_200000_times_with_intensities", many);
  add("no_points", {}, true);
}

void radio(const fs::path& corpus) {
  const Seeds seeds(corpus, "radio_datagrams");
  const trust::Session session{1, 15, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const trust::Credentials r1 = credentials_of("r1", key_of_r1(), 1);
  const Bytes text{'h', 'e', 'l', 'l', 'o'};
  trust::DatagramSealer sealer(r1, r1.certificate.name, 1, session);
  seeds.add("greeting", 0, sealer.seal(trust::DatagramKind::kGreeting, text));
  seeds.add("message", 0, sealer.seal(trust::DatagramKind::kMessage, text));
  seeds.add("introduction", 1, trust::Introducer(r1, 1, session).introduce(text, {}, true, true));
  seeds.add("sealed", 2, text);
  seeds.add("changed", 3, Bytes{9, 1, 'h', 'e', 'l', 'l', 'o'});

  bus::Hello hello;
  hello.sender = r1.certificate.name;
  hello.address = {10, 0, 0, 1};
  hello.port = 7660;
  hello.link = bus::Link::kLongRange;
  hello.settings = bus::FleetSettings{.wire_schema = 5, .fleet = 1};
  hello.reads = {1, 2, 3};
  hello.introduces = {
      {.prefix = {1, 15, 9}, .agent = r1.certificate.name, .address = {10, 0, 0, 2}, .port = 7660}};
  const Bytes cdr = bus::encode(hello);
  Bytes rtps{'R', 'T', 'P', 'S', 2, 3, 1, 15, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 0x15, 5, 0, 0};
  rtps.insert(rtps.end(), {0, 0, 16, 0, 0, 0, 0, 0, 0xff, 0, 0, 3, 0, 0, 0, 0, 1, 0, 0, 0});
  rtps.insert(rtps.end(), cdr.begin(), cdr.end());
  const Seeds hellos(corpus, "radio_hellos");
  hellos.add("hello", cdr);
  hellos.add("hello_in_rtps", rtps);
}

void keys(const fs::path& corpus) {
  const Seeds seeds(corpus, "key_files");
  const trust::Credentials r2 = credentials_of("r2", key_of_r2(), 2);
  const Bytes crl = trust::sign_revocations(r2.authority, authority_key(), {3, {1, 7}}, kNow);
  seeds.add("authority", 0, trust::to_pem(r2.authority.der, trust::kCertificatePem));
  seeds.add("certificate", 1, trust::to_pem(r2.certificate.der, trust::kCertificatePem));
  seeds.add("key", 2, r2.key.to_pem());
  seeds.add("fleet_keys", 3, trust::to_text(r2.fleet_keys));
  seeds.add("revocations", 4, trust::to_pem(crl, trust::kRevocationsPem));
  seeds.add("certificate_der", 6, r2.certificate.der);
  seeds.add("revocations_der", 6, crl);
}

/// Pages of 512 bytes and nothing that is not needed: a database in a few kB.
void shrink(const fs::path& file) {
  sqlite3* database = nullptr;
  require(sqlite3_open(file.c_str(), &database) == SQLITE_OK, "the database cannot be opened");
  const char* sql = "PRAGMA journal_mode = DELETE; PRAGMA page_size = 512; VACUUM;";
  require(sqlite3_exec(database, sql, nullptr, nullptr, nullptr) == SQLITE_OK,
          "the database cannot be shrunk");
  sqlite3_close(database);
}

void add_file(const Seeds& seeds, const std::string& name, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  seeds.add(name, ByteView(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

void bag(const fs::path& corpus) {
  const Folder folder;
  {
    auto bag =
        recording::BagWriter::create(folder.path() / "drive", {.storage = recording::BagStorage::kSqlite})
            .value();
    const auto put = [&](const bus::Topic& topic, const Bytes& cdr) {
      require(bag.write(topic.name, topic.type, kNow, cdr).has_value(), "the bag cannot be written");
    };
    put(ros_codec::topics::points(), ros_codec::encode(small_scan()));
    put(ros_codec::topics::imu(), ros_codec::encode(small_imu()));
    put(ros_codec::topics::fix(), ros_codec::encode(small_fix()));
    put(ros_codec::topics::wheel_odometry(), ros_codec::encode(sensor::Wheel{kNow, 1.0, 0.1}));
  }
  for (const auto& entry : fs::directory_iterator(folder.path() / "drive")) {
    if (entry.path().extension() == ".yaml") add_file({corpus, "bag_metadata"}, "metadata", entry.path());
    if (entry.path().extension() != ".db3") continue;
    shrink(entry.path());
    add_file({corpus, "bag"}, "four_messages", entry.path());
  }
}

void stores(const fs::path& corpus) {
  const Folder folder;
  const AgentId self = AgentId::parse("r1").value();
  const AgentId other = AgentId::parse("r2").value();
  const fs::path file = folder.path() / "store.db";
  const Bytes submap = testing::random_bytes(100, 1);
  const auto own = testing::make_node(self, first_seq(1), submap);
  const auto foreign = testing::make_node(other, first_seq(2), submap);
  const auto alignment = testing::make_alignment(own.id, foreign.id, self, first_seq(1));
  {
    auto store = store::Store::open(file, self).value();
    require(store.put_node_with_submap(own, submap) == store::Put::kAdded, "the node is refused");
    require(store.put_node(foreign) == store::Put::kAdded, "the node is refused");
    require(store.put_alignment(alignment) == store::Put::kAdded, "the alignment is refused");
  }
  shrink(file);
  add_file({corpus, "store_file"}, "two_nodes", file);
  const Seeds items(corpus, "store_items");
  items.add("node", store::encode(own));
  items.add("alignment", store::encode(alignment));
}

/// The first packet of a turn, its last one and the next.
ros_codec::VelodyneScan three_packets(std::uint8_t product, std::uint8_t mode) {
  ros_codec::VelodyneScan scan{kNow, {}};
  const auto add = [&](testing::VelodyneDevice device, int packets) {
    device.product = product;
    device.mode = mode;
    for (int k = 0; k < packets; ++k) {
      auto packet = device.next();
      scan.packets.push_back({Stamp(packet.fired), std::move(packet.bytes)});
    }
  };
  const Duration start = kNow.time_since_epoch();
  add(testing::VelodyneDevice(start, 1.0), 1);
  add(testing::VelodyneDevice(start + std::chrono::milliseconds(99), 358.4), 2);
  return scan;
}

void velodyne(const fs::path& corpus) {
  const Seeds seeds(corpus, "velodyne");
  seeds.add("vlp16_message", 0, ros_codec::encode(three_packets(0x22, 0x37)));
  Bytes datagrams;
  for (const auto& packet : three_packets(0x28, 0x39).packets) {
    datagrams.insert(datagrams.end(), {10, 0});
    datagrams.insert(datagrams.end(), packet.data.begin(), packet.data.end());
  }
  seeds.add("vlp32c_dual_datagrams", 1, datagrams);
  namespace pcap = recording::testing;
  std::string capture = pcap::pcap_header();
  for (const auto& packet : three_packets(0x21, 0x38).packets)
    capture += pcap::pcap_record(packet.received, pcap::udp_frame({}, packet.data));
  Seeds(corpus, "pcap")
      .add("hdl32e", ByteView(reinterpret_cast<const std::uint8_t*>(capture.data()), capture.size()));
}

/// The last packet of a turn of 64 columns, one of the IMU and the first of the next turn, in every format.
void ouster(const fs::path& corpus) {
  const Seeds seeds(corpus, "ouster");
  std::size_t choice = 0;
  for (const char* profile : {"LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
                              "RNG15_RFL8_NIR8", "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"}) {
    testing::OusterDevice device(std::chrono::seconds(140), 60);
    device.profile = profile;
    device.columns = 64;
    device.columns_per_packet = 4;
    Bytes datagrams;
    const auto add = [&](std::uint8_t kind, const Bytes& packet) {
      datagrams.insert(datagrams.end(), {10, 0, kind});
      datagrams.insert(datagrams.end(), packet.begin(), packet.end());
    };
    add(0, device.next().bytes);
    add(1, testing::OusterDevice::imu(std::chrono::seconds(140), {0.0f, 0.0f, 1.0f}, {1.0f, 2.0f, 3.0f}));
    add(0, device.next().bytes);
    seeds.add(profile, choice++, datagrams);
  }
  testing::OusterDevice device(Duration::zero());
  seeds.add("metadata", choice, device.metadata());
  seeds.add("metadata_in_sections", choice, device.metadata(true));
}

void scans(const fs::path& corpus) {
  const Seeds seeds(corpus, "kitti");
  const Bytes scan(64, 0x41);
  Bytes packed(1024);
  std::size_t size = 0;
  require(lzma_easy_buffer_encode(0, LZMA_CHECK_CRC32, nullptr, scan.data(), scan.size(), packed.data(),
                                  &size, packed.size()) == LZMA_OK,
          "xz cannot be packed");
  packed.resize(size);
  seeds.add("bin", 0, scan);
  seeds.add("xz", 1, packed);
}

/// Without the header, which the target puts before its input.
void previews(const fs::path& corpus) {
  monitor::QuantisedCloud cloud;
  cloud.whole = 15'000;
  cloud.values = {1, 2, 3, 4, -5, 6, 7, 8};
  const auto three = std::make_shared<const monitor::QuantisedCloud>(cloud);
  const Bytes file =
      monitor::encoded_previews({{std::string(32, '1'), three}, {std::string(32, 'f'), three}});
  Seeds(corpus, "preview_file").add("two_submaps", ByteView(file).subspan(monitor::kPreviewHeaderBytes));
}

}  // namespace
}  // namespace fleetmap::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_fuzz_seeds tests/fuzz/corpus\n";
    return 2;
  }
  using namespace fleetmap::fuzz;
  for (const auto make : {fleet_messages, ros_messages, encoded_clouds, radio, keys, bag, stores, velodyne,
                          ouster, scans, previews})
    make(argv[1]);
  return 0;
}
