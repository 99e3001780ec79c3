#include "pcap_reader.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "datagram_stream.hpp"
#include "fleetmap/core/paths.hpp"
#include "ouster_reader.hpp"
#include "packet_counters.hpp"
#include "packet_reader.hpp"
#include "pcap_file.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

class PcapReader : public PacketReader {
 public:
  PcapReader(std::string source, ScanContent content, PcapFile file, DatagramStream device)
      : PacketReader(std::move(source), content), file_(std::move(file)), device_(device) {}

  Result<std::optional<Sample>> next() override {
    while (true) {
      if (auto scan = next_scan()) {
        captured_ = scan->recorded;
        return Sample(std::move(scan->scan));
      }
      if (ended_) return std::optional<Sample>();
      const auto datagram = file_.next();
      if (!datagram) ended_ = true;
      if (!datagram) return tl::unexpected(datagram.error());
      if (*datagram) {
        add(**datagram);
      } else {
        end();
      }
    }
  }
  std::optional<Stamp> recorded() const override { return captured_; }

 private:
  void add(const Datagram& datagram) {
    if (stream_of(datagram) == device_)
      return add_packet(datagram.payload, datagram.captured, datagram.captured);
    if (sensor::read_velodyne_packet(datagram.payload))
      skip(&Counters::packets_of_other_devices, "packets of another LiDAR, from " +
                                                    to_string(stream_of(datagram)) + ", beside those from " +
                                                    to_string(device_));
  }
  void end() {
    ended_ = true;
    finish_packets();
    if (file_.ended_within_record()) skip(&Counters::damaged_parts, "the capture ends within a frame");
    if (const std::uint64_t cut = file_.cut_datagrams()) skip(&Counters::damaged_parts, kCutDatagrams, cut);
  }

  PcapFile file_;
  DatagramStream device_;
  bool ended_ = false;
  std::optional<Stamp> captured_;
};

/// Ouster's tools store a capture and its metadata under one name.
fs::path metadata_beside(fs::path capture) { return capture.replace_extension(".json"); }

/// The first device whose packets are decoded.
Result<DatagramStream> find_device(const fs::path& path) {
  auto file = PcapFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::string reason;
  while (true) {
    const auto datagram = file->next();
    if (!datagram) return tl::unexpected(datagram.error());
    if (!*datagram) break;
    const auto packet = sensor::read_velodyne_packet((*datagram)->payload);
    if (packet) return stream_of(**datagram);
    if (packet.error().fault != sensor::PacketFault::kSize && reason.empty())
      reason = "; one of its size is refused: " + packet.error().what;
  }
  return failure(path.string() + ": no data packet of a Velodyne LiDAR (1206 bytes over UDP) among " +
                 std::to_string(file->frames()) + " frames" + reason +
                 "; for an Ouster LiDAR name its metadata (lidar.ouster_metadata), or put them beside as " +
                 metadata_beside(path).filename().string());
}

}  // namespace

bool is_capture(const fs::path& path) { return path.extension() == ".pcap" || path.extension() == ".pcapng"; }

Result<std::unique_ptr<Reader>> open_capture(const fs::path& path,
                                             const std::optional<sensor::OusterMetadata>& ouster,
                                             ScanContent content) {
  if (ouster) return open_ouster_capture(path, *ouster, content);
  if (const fs::path beside = metadata_beside(path); is_there(beside)) {
    if (const auto metadata = sensor::load_ouster_metadata(beside)) {
      spdlog::info("{}: of {}, by {}", path.string(), metadata->device, beside.string());
      return open_ouster_capture(path, *metadata, content);
    } else {
      spdlog::warn("{}; so {} is not read as a capture of an Ouster LiDAR", metadata.error().message,
                   path.string());
    }
  }
  const auto device = find_device(path);
  if (!device) return tl::unexpected(device.error());
  auto file = PcapFile::open(path);
  if (!file) return tl::unexpected(file.error());
  return std::make_unique<PcapReader>(path.string(), content, std::move(*file), *device);
}

}  // namespace fleetmap::recording
