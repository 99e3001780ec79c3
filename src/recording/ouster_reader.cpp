#include "ouster_reader.hpp"

#include <optional>
#include <string>
#include <utility>

#include "checked_reader.hpp"
#include "datagram_stream.hpp"
#include "fleetmap/sensor/ouster_sensor.hpp"
#include "packet_counters.hpp"
#include "pcap_file.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

class OusterReader : public CheckedReader {
 public:
  OusterReader(std::string source, ScanContent content, PcapFile file, DatagramStream lidar,
               const sensor::OusterMetadata& metadata)
      : CheckedReader(std::move(source), content),
        file_(std::move(file)),
        lidar_(lidar),
        imu_{lidar.source, metadata.imu_port},
        sensor_(metadata) {}

  Result<std::optional<Sample>> next() override {
    while (true) {
      if (auto scan = sensor_.take()) {
        if (auto sample = checked(std::move(*scan))) return sample;
        continue;
      }
      if (ended_) return std::optional<Sample>();
      const auto datagram = file_.next();
      if (!datagram) ended_ = true;
      if (!datagram) return tl::unexpected(datagram.error());
      if (!*datagram) {
        end();
      } else if (auto sample = sample_in(**datagram)) {
        return sample;
      }
    }
  }
  std::optional<Stamp> recorded() const override { return captured_; }

 private:
  /// A sample of the IMU; packets of the LiDAR complete a scan.
  std::optional<Sample> sample_in(const Datagram& datagram) {
    const DatagramStream stream = stream_of(datagram);
    if (stream == lidar_) {
      captured_ = datagram.captured;
      if (const auto added = sensor_.add_lidar(datagram.payload, datagram.captured); !added)
        skip(counter_of(added.error().fault), added.error().what);
      count_incomplete();
    } else if (stream == imu_) {
      captured_ = datagram.captured;
      auto imu = sensor_.add_imu(datagram.payload, datagram.captured);
      if (!imu) {
        skip(counter_of(imu.error().fault), imu.error().what);
      } else if (Sample sample(std::move(*imu)); admit(sample)) {
        return sample;
      }
    } else if (sensor::read_ouster_packet(datagram.payload, sensor_.metadata())) {
      skip(&Counters::packets_of_other_devices, "packets of another LiDAR, from " + to_string(stream) +
                                                    ", beside those from " + to_string(lidar_));
    }
    return std::nullopt;
  }

  std::optional<Sample> checked(sensor::Scan&& scan) {
    ros_codec::DecodedScan decoded{.scan = std::move(scan)};
    if (!admit_points(decoded, "a turn")) return std::nullopt;
    Sample sample(std::move(decoded.scan));
    if (!admit(sample)) return std::nullopt;
    if (stamps_only()) std::get<sensor::Scan>(sample).points.clear();
    return sample;
  }

  void end() {
    ended_ = true;
    sensor_.finish();
    count_incomplete();
    if (file_.ended_within_record()) skip(&Counters::damaged_parts, "the capture ends within a frame");
    if (const std::uint64_t cut = file_.cut_datagrams()) skip(&Counters::damaged_parts, kCutDatagrams, cut);
  }
  void count_incomplete() {
    const std::uint64_t more = sensor_.counters().incomplete_sweeps - counters_.incomplete_sweeps;
    if (more > 0) skip(&Counters::incomplete_sweeps, kIncompleteSweep, more);
  }

  PcapFile file_;
  DatagramStream lidar_, imu_;
  sensor::OusterSensor sensor_;
  bool ended_ = false;
  std::optional<Stamp> captured_;
};

/// The first device whose packets are decoded.
Result<DatagramStream> find_lidar(const fs::path& path, const sensor::OusterMetadata& metadata) {
  auto file = PcapFile::open(path);
  if (!file) return tl::unexpected(file.error());
  while (true) {
    const auto datagram = file->next();
    if (!datagram) return tl::unexpected(datagram.error());
    if (!*datagram) break;
    if (sensor::read_ouster_packet((*datagram)->payload, metadata)) return stream_of(**datagram);
  }
  return failure(path.string() + ": no packet of " + std::to_string(metadata.lidar_packet_bytes()) +
                 " bytes, as the metadata of " + metadata.device + " (" + std::string(metadata.profile.name) +
                 ") have it, among " + std::to_string(file->frames()) +
                 " frames; are the metadata those of this capture?" +
                 (file->cut_datagrams() > 0 ? std::string(" Also, ") + kCutDatagrams : ""));
}

}  // namespace

Result<std::unique_ptr<Reader>> open_ouster_capture(const fs::path& path,
                                                    const sensor::OusterMetadata& metadata,
                                                    ScanContent content) {
  const auto lidar = find_lidar(path, metadata);
  if (!lidar) return tl::unexpected(lidar.error());
  auto file = PcapFile::open(path);
  if (!file) return tl::unexpected(file.error());
  return std::make_unique<OusterReader>(path.string(), content, std::move(*file), *lidar, metadata);
}

}  // namespace fleetmap::recording
