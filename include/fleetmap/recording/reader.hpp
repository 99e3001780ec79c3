#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/recording/kitti_config.hpp"
#include "fleetmap/recording/reader_config.hpp"
#include "fleetmap/sensor/frame_tree.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sensor/scan.hpp"

/// Recordings in: what a robot's sensors measured, sample by sample, in the order in which it was recorded.
namespace fleetmap::recording {

using Sample = std::variant<sensor::Scan, sensor::Imu, sensor::Fix, sensor::Wheel>;
Stamp stamp_of(const Sample& sample);

/// Counts of samples that were read, and of those left out with the reason.
struct Counters {
  std::uint64_t scans = 0, imus = 0, fixes = 0, wheels = 0;  ///< given out
  std::uint64_t non_finite_points = 0;                       ///< of the scans read
  std::uint64_t origin_points = 0;              ///< exactly (0, 0, 0): no return; of the scans read
  std::uint64_t noise_points = 0;               ///< marked as noise by a Livox LiDAR; of the scans read
  std::uint64_t undecodable_messages = 0;       ///< truncated or contradictory; skipped
  std::uint64_t damaged_parts = 0;              ///< of an mcap, ROS 1 or pcap file, also a cut end; left out
  std::uint64_t empty_scans = 0;                ///< without a single return; skipped
  std::uint64_t time_backwards = 0;             ///< not later than the one before of its kind; skipped
  std::uint64_t clocks_set_back = 0;            ///< times that the stamps of a kind went on far earlier
  std::uint64_t foreign_time_unit_scans = 0;    ///< point times are in no unit, or in another than defined
  std::uint64_t foreign_clock_scans = 0;        ///< point times in a clock unrelated to the scan's stamp
  std::uint64_t unstamped_messages = 0;         ///< header stamp 0: the time of recording was taken
  std::uint64_t packets_of_wrong_size = 0;      ///< of a LiDAR, as the next two; skipped
  std::uint64_t packets_of_wrong_blocks = 0;    ///< they contradict the format or those before; skipped
  std::uint64_t packets_of_unknown_device = 0;  ///< product id or return mode; skipped
  std::uint64_t packets_of_other_devices = 0;   ///< of a capture with several LiDARs; skipped
  std::uint64_t incomplete_sweeps = 0;          ///< a part of a turn at an end or a pause; skipped
  std::uint64_t unreadable_scan_files = 0;      ///< KITTI; skipped
  std::uint64_t missing_scan_frames = 0;        ///< KITTI: a gap in the numbers of the scan files
  std::uint64_t missing_oxts_frames = 0;        ///< KITTI: a scan without its OXTS record
  std::uint64_t malformed_oxts_frames = 0;      ///< KITTI; skipped

  /// (name, count) of all, for reports.
  std::vector<std::pair<std::string, std::uint64_t>> named() const;
};

/// Selects what is decoded of the scans of a bag.
enum class ScanContent : std::uint8_t {
  kPoints,
  kStampOnly,  ///< scans without points, whose messages are not checked either
};

/// Reads a recording sample by sample; holds no more than one scan in memory. Each reason for leaving
/// something out is logged once (warn) and counted.
class Reader {
 public:
  virtual ~Reader() = default;
  /// The next sample; empty at the end. After an Error the rest cannot be read, and the end follows.
  virtual Result<std::optional<Sample>> next() = 0;
  /// The time at which the last sample of next() was recorded; empty if the recording lacks it.
  virtual std::optional<Stamp> recorded() const { return std::nullopt; }
  /// The frames that the messages of a bag named so far.
  virtual const sensor::SensorFrames& frames() const;
  virtual const Counters& counters() const = 0;
  /// Errors of a driver that the samples no longer show since they are corrected here, each with its remedy.
  virtual const std::vector<std::string>& findings() const;
};

/// Opens a rosbag2 folder or a single file of one (.db3 or .mcap, plain, lz4 or zstd), a ROS 1 bag, a capture
/// of the packets of a Velodyne or an Ouster LiDAR (.pcap), a KITTI folder (raw: velodyne_points and oxts;
/// odometry benchmark: velodyne and times.txt, scans that are motion compensated), or a bare folder of scans
/// (.bin or .pcd, as everywhere also as .xz). Missing parts of such a folder are assumed with a warning.
/// Errors name the remedy for other formats and topics that cannot be chosen.
Result<std::unique_ptr<Reader>> open(const std::filesystem::path& path, const ReaderConfig& config = {},
                                     ScanContent content = ScanContent::kPoints);

}  // namespace fleetmap::recording
