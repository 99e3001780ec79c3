#include "pcap_reader.hpp"

#include <utility>

#include "packet_reader.hpp"
#include "pcap_file.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

/// Source and destination of the packets of a device.
struct Stream {
  std::uint32_t source = 0;
  std::uint16_t port = 0;
  bool operator==(const Stream&) const = default;
};

Stream stream_of(const Datagram& datagram) { return {datagram.source, datagram.port}; }

std::string text_of(const Stream& stream) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8)
    text += std::to_string(stream.source >> shift & 0xff) + (shift > 0 ? "." : "");
  return text + " to port " + std::to_string(stream.port);
}

class PcapReader : public PacketReader {
 public:
  PcapReader(std::string source, ScanContent content, PcapFile file, Stream device)
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
                                                    text_of(stream_of(datagram)) + ", beside those from " +
                                                    text_of(device_));
  }
  void end() {
    ended_ = true;
    finish_packets();
    if (file_.ended_within_record()) skip(&Counters::damaged_parts, "the capture ends within a frame");
    if (const std::uint64_t cut = file_.cut_datagrams())
      skip(&Counters::damaged_parts, "datagrams are cut; capture whole frames (tcpdump -s 0)", cut);
  }

  PcapFile file_;
  Stream device_;
  bool ended_ = false;
  std::optional<Stamp> captured_;
};

/// The first device whose packets are decoded.
Result<Stream> find_device(const fs::path& path) {
  auto file = PcapFile::open(path);
  if (!file) return tl::unexpected(file.error());
  std::string reason;
  while (true) {
    const auto datagram = file->next();
    if (!datagram) return tl::unexpected(datagram.error());
    if (!*datagram) break;
    const auto packet = sensor::read_velodyne_packet((*datagram)->payload);
    if (packet) return stream_of(**datagram);
    if (packet.error().fault != sensor::VelodyneFault::kSize && reason.empty())
      reason = "; one of its size is refused: " + packet.error().what;
  }
  return failure(path.string() + ": no data packet of a Velodyne LiDAR (1206 bytes over UDP) among " +
                 std::to_string(file->frames()) + " frames" + reason);
}

}  // namespace

bool is_capture(const fs::path& path) { return path.extension() == ".pcap" || path.extension() == ".pcapng"; }

Result<std::unique_ptr<Reader>> open_capture(const fs::path& path, ScanContent content) {
  const auto device = find_device(path);
  if (!device) return tl::unexpected(device.error());
  auto file = PcapFile::open(path);
  if (!file) return tl::unexpected(file.error());
  return std::make_unique<PcapReader>(path.string(), content, std::move(*file), *device);
}

}  // namespace fleetmap::recording
