#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/recording/reader.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"

namespace fleetmap::recording {

/// Checks that every reader applies to a sample, and the log of what they leave out.
class CheckedReader : public Reader {
 public:
  /// One of stamps only logs nothing: the recording is read with its points as well, which states the same.
  explicit CheckedReader(std::string source, ScanContent content = ScanContent::kPoints)
      : source_(std::move(source)), content_(content) {}
  const Counters& counters() const override { return counters_; }
  const std::vector<std::string>& findings() const override { return findings_; }

 protected:
  /// False, counted, when the sample is not later than the one before of its kind; else it counts as given
  /// out. Several in a row that are far earlier mean that the clock was set back: from then on they are given
  /// out again, as a live sensor's would come.
  bool admit(const Sample& sample);
  /// False, counted, for a scan without a return; else its dropped points are counted.
  bool admit_points(const ros_codec::DecodedScan& decoded, const std::string& where);
  /// Counts, and logs the first of each kind.
  void skip(std::uint64_t Counters::*reason, const std::string& what, std::uint64_t count = 1);

  void warn(const std::string& news) const;
  /// Keeps a finding, once.
  void add_finding(const std::string& finding);

  const std::string& source() const { return source_; }
  bool stamps_only() const { return content_ == ScanContent::kStampOnly; }
  Counters counters_;

 private:
  std::string source_;
  ScanContent content_;
  std::set<std::string> logged_;
  std::vector<std::string> findings_;
  struct Last {
    std::optional<Stamp> admitted;  ///< stamp of the last that was admitted
    std::optional<Stamp> skipped;   ///< of the last since that was not, if it was far earlier
    int set_back = 0;               ///< of these, in a row and in order
  };
  std::array<Last, std::variant_size_v<Sample>> last_;
};

}  // namespace fleetmap::recording
