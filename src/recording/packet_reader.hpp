#pragma once

#include <optional>
#include <string>

#include "checked_reader.hpp"
#include "fleetmap/sensor/velodyne_sweeps.hpp"

namespace fleetmap::recording {

/// A reader of recordings that hold packets of a LiDAR, of which it makes scans.
class PacketReader : public CheckedReader {
 public:
  PacketReader(std::string source, ScanContent content) : CheckedReader(std::move(source), content) {}

 protected:
  struct PacketScan {
    sensor::Scan scan;
    std::optional<Stamp> recorded;  ///< the packet that completed it
  };

  /// Counts and names datagrams that are no packet. `arrival` resolves the packet's hour.
  void add_packet(ByteView packet, Stamp arrival, Stamp recorded);
  void finish_packets();
  /// The next complete scan that passes the checks.
  std::optional<PacketScan> next_scan();

 private:
  void count_incomplete();

  sensor::VelodyneSweeps sweeps_;
  std::optional<Stamp> recorded_;
};

}  // namespace fleetmap::recording
