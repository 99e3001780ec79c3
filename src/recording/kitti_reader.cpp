#include "kitti_reader.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <deque>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "checked_reader.hpp"
#include "fleetmap/core/paths.hpp"
#include "oxts.hpp"
#include "scan_file.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFrame = 100'000'000;

/// "0000000012.pcd.xz" -> 12; empty when the name is no number.
std::optional<std::size_t> frame_number(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::string stem = name.substr(0, name.find('.'));
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (stem.empty() || error != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
  return number <= kMaxFrame ? std::optional(number) : std::nullopt;
}

/// The paths of a recording in KITTI's formats.
struct Layout {
  fs::path scans;
  fs::path scan_stamps;  ///< a file; it need not be there
  fs::path oxts;         ///< a folder, likewise
  fs::path oxts_stamps;
  bool motion_compensated = false;
  bool numbered = true;  ///< files are named by their frame; else frames count in order of names
};

using Frames = std::map<std::size_t, fs::path>;

bool is_oxts_file(const fs::path& file) { return file.extension() == ".txt"; }

/// The scans, or the OXTS records, of `folder`/data, or of `folder` itself.
std::vector<fs::path> files_in(const fs::path& folder, bool (*wanted)(const fs::path&)) {
  std::vector<fs::path> files;
  if (folder.empty()) return files;
  const fs::path place = is_folder(folder / "data") ? folder / "data" : folder;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(place, error)) {
    if (wanted(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

Frames by_frame(const std::vector<fs::path>& files, bool numbered, const KittiConfig& config) {
  Frames frames;
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto number = numbered ? frame_number(files[k]) : std::optional(k);
    if (number && *number >= config.first_frame && *number <= config.last_frame)
      frames.emplace(*number, files[k]);
  }
  return frames;
}

/// The layout of `path`, if it is one of KITTI's or a bare folder of scans.
std::optional<Layout> layout_of(const fs::path& path) {
  if (is_folder(path / "velodyne_points")) {
    return Layout{path / "velodyne_points", path / "velodyne_points" / "timestamps.txt", path / "oxts",
                  path / "oxts" / "timestamps.txt"};
  }
  if (is_folder(path / "velodyne"))
    return Layout{path / "velodyne", path / "times.txt", {}, {}, /*motion_compensated=*/true};
  const fs::path whole = absolute_path(path).lexically_normal();
  const fs::path folder = whole.has_filename() ? whole : whole.parent_path();
  if (folder.filename() == "velodyne" && is_there(folder.parent_path() / "times.txt"))
    return layout_of(folder.parent_path());
  const std::vector<fs::path> scans =
      is_folder(path) ? files_in(path, is_scan_file) : std::vector<fs::path>();
  if (scans.empty()) return std::nullopt;
  const fs::path stamps = path / (is_there(path / "times.txt") ? "times.txt" : "timestamps.txt");
  const bool numbered =
      std::ranges::all_of(scans, [](const fs::path& scan) { return frame_number(scan).has_value(); });
  return Layout{path, stamps, {}, {}, /*motion_compensated=*/false, numbered};
}

/// "2011-09-26 13:02:25.594360375", taken as UTC.
std::optional<Stamp> parse_timestamp(const std::string& line) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, used = 0;
  long double second = 0;
  if (std::sscanf(line.c_str(), "%d-%d-%d %d:%d:%Lf%n", &year, &month, &day, &hour, &minute, &second,
                  &used) != 6) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  const bool plausible = date.ok() && year >= 1970 && year <= 2116 && hour >= 0 && hour < 24 && minute >= 0 &&
                         minute < 60 && second >= 0 && second < 61;
  if (!plausible) return std::nullopt;
  return Stamp(std::chrono::sys_days(date)) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
         Duration(std::llround(second * 1e9L));
}

/// "1.036e-01": seconds since the recording began.
std::optional<Stamp> parse_seconds(const std::string& line) {
  std::istringstream words(line);
  double seconds = 0.0;
  std::string more;
  if (!(words >> seconds) || words >> more || !(seconds >= 0.0 && seconds < 4e9)) return std::nullopt;
  return Stamp(from_seconds(seconds));
}

/// Stamp of each frame by line, or nothing when there is no such file.
Result<std::vector<Stamp>> read_timestamps(const fs::path& file) {
  std::vector<Stamp> stamps;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.find_first_not_of(" \r\t") == std::string::npos) continue;
    auto stamp = parse_timestamp(line);
    if (!stamp) stamp = parse_seconds(line);
    if (!stamp) {
      return failure(file.string() + ":" + std::to_string(stamps.size() + 1) + ": '" + line.substr(0, 40) +
                     "' is no time such as 2011-09-26 13:02:25.594360375 or 1.036e-01 (s)");
    }
    stamps.push_back(*stamp);
  }
  return stamps;
}

class KittiReader : public CheckedReader {
 public:
  struct Files {
    Frames scans, oxts;
    std::vector<Stamp> scan_stamps, oxts_stamps;
    bool motion_compensated = false;
  };
  KittiReader(std::string source, Files files, const KittiConfig& config, ScanContent content)
      : CheckedReader(std::move(source), content), config_(config), files_(std::move(files)) {
    if (config.fix_degradation) fix_error_.emplace(*config.fix_degradation);
    count_gaps();
  }

  Result<std::optional<Sample>> next() override {
    while (true) {
      while (!ready_.empty()) {
        Sample sample = std::move(ready_.front());
        ready_.pop_front();
        if (admit(sample)) return std::optional<Sample>(std::move(sample));
      }
      if (files_.scans.empty() && files_.oxts.empty()) return std::optional<Sample>();
      advance();
    }
  }

 private:
  void count_gaps() {
    std::optional<std::size_t> before;
    for (const auto& [k, file] : files_.scans) {
      if (before && k > *before + 1) {
        skip(&Counters::missing_scan_frames, "no scan of frame " + std::to_string(*before + 1),
             k - *before - 1);
      }
      before = k;
    }
    if (files_.oxts.empty()) return;
    for (const auto& [k, file] : files_.scans) {
      if (!files_.oxts.contains(k))
        skip(&Counters::missing_oxts_frames, "frame " + std::to_string(k) + " has no OXTS record");
    }
  }

  Stamp stamp(const std::vector<Stamp>& stamps, std::size_t frame) const {
    if (frame < stamps.size()) return stamps[frame];
    return Stamp(from_seconds(static_cast<double>(frame) / config_.nominal_rate));
  }

  /// Reads the earlier of the next scan and the next OXTS record; of the same time, the record first.
  void advance() {
    const bool oxts_first =
        files_.scans.empty() ||
        (!files_.oxts.empty() && stamp(files_.oxts_stamps, files_.oxts.begin()->first) <=
                                     stamp(files_.scan_stamps, files_.scans.begin()->first));
    auto& frames = oxts_first ? files_.oxts : files_.scans;
    const auto frame = frames.extract(frames.begin());
    if (oxts_first) {
      read_oxts(frame.mapped(), stamp(files_.oxts_stamps, frame.key()));
    } else {
      read_scan(frame.mapped(), stamp(files_.scan_stamps, frame.key()));
    }
  }

  void read_scan(const fs::path& file, Stamp stamp) {
    auto decoded = read_scan_file(file);
    if (!decoded) return skip(&Counters::unreadable_scan_files, decoded.error().message);
    if (!admit_points(*decoded, file.string())) return;
    decoded->scan.stamp = stamp;
    // All points are where the scanner would have seen them at the stamp: their times are 0 and known.
    decoded->scan.has_time = files_.motion_compensated;
    ready_.emplace_back(std::move(decoded->scan));
  }

  void read_oxts(const fs::path& file, Stamp stamp) {
    auto frame = read_oxts_file(file, stamp);
    if (!frame) return skip(&Counters::malformed_oxts_frames, frame.error().message);
    if (!config_.wheel_yaw_rate) frame->wheel.yaw_rate.reset();
    ready_.emplace_back(frame->imu);
    ready_.emplace_back(frame->wheel);
    ready_.emplace_back(fix_error_ ? fix_error_->degraded(frame->fix) : frame->fix);
  }

  KittiConfig config_;
  Files files_;  ///< not read yet
  std::optional<FixError> fix_error_;
  std::deque<Sample> ready_;  ///< of one frame
};

/// Stamps by the files of the layout, or nominal ones for both.
Status read_stamps(const Layout& layout, KittiReader::Files& files) {
  auto scans = read_timestamps(layout.scan_stamps);
  if (!scans) return tl::unexpected(scans.error());
  auto oxts = read_timestamps(layout.oxts_stamps);
  if (!oxts) return tl::unexpected(oxts.error());
  if (scans->empty() != oxts->empty() && !files.oxts.empty()) {
    // One clock for both: the frames were triggered together.
    (scans->empty() ? *scans : *oxts) = scans->empty() ? *oxts : *scans;
  }
  const auto short_of = [](const std::vector<Stamp>& stamps, const Frames& frames) {
    return !stamps.empty() && !frames.empty() && frames.rbegin()->first >= stamps.size();
  };
  if (short_of(*scans, files.scans) || short_of(*oxts, files.oxts)) {
    return failure((short_of(*scans, files.scans) ? layout.scan_stamps : layout.oxts_stamps).string() +
                   " has fewer lines than there are frames");
  }
  files.scan_stamps = std::move(*scans);
  files.oxts_stamps = std::move(*oxts);
  return {};
}

/// Logs assumptions that replace missing files.
void log_assumptions(const Layout& layout, const KittiReader::Files& files, const KittiConfig& config) {
  const std::string where = layout.scans.string();
  if (files.scan_stamps.empty()) {
    spdlog::warn(
        "{}: there is no {}, so frame k is taken to be of {:.4g} s * k; recording.frame_rate sets it", where,
        layout.scan_stamps.filename().string(), 1.0 / config.nominal_rate);
  }
  if (!layout.numbered)
    spdlog::warn("{}: the scans are not named by numbers and are read in the order of their names", where);
  if (layout.motion_compensated) {
    spdlog::info("{}: KITTI's odometry benchmark, whose scans are motion compensated already", where);
  } else if (layout.oxts.empty()) {
    spdlog::warn(
        "{}: scans without times of their points; set lidar.model to the scanner that made them, and "
        "odometry.deskew=false if they are motion compensated already",
        where);
  }
}

}  // namespace

bool has_kitti_layout(const fs::path& path) { return layout_of(path).has_value(); }

Result<std::unique_ptr<Reader>> open_kitti(const fs::path& path, const KittiConfig& config,
                                           ScanContent content) {
  const Layout layout = layout_of(path).value();
  KittiReader::Files files;
  files.motion_compensated = layout.motion_compensated;
  files.scans = by_frame(files_in(layout.scans, is_scan_file), layout.numbered, config);
  files.oxts = by_frame(files_in(layout.oxts, is_oxts_file), true, config);
  if (files.scans.empty()) {
    return failure(layout.scans.string() +
                   " has no scan (.bin, .pcd, or either with .xz) among the frames asked for");
  }
  if (auto status = read_stamps(layout, files); !status) return tl::unexpected(status.error());
  // A recording is surveyed before it is read with points, which states the same.
  if (content == ScanContent::kPoints) log_assumptions(layout, files, config);
  return std::make_unique<KittiReader>(path.string(), std::move(files), config, content);
}

}  // namespace fleetmap::recording
