#include "unread_parts.hpp"

#include <cstdint>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::apps {

std::vector<std::string> unread_parts(const recording::Counters& counters) {
  std::vector<std::string> findings;
  const auto add = [&](std::uint64_t count, const char* one, const char* many, const char* what) {
    if (count > 0) findings.push_back(std::to_string(count) + (count == 1 ? one : many) + what);
  };
  add(counters.damaged_parts, " part of the recording is", " parts of the recording are",
      " damaged or cut off and left out: copy it again from where it was recorded (mcap recover and "
      "rosbag reindex save what can be read)");
  add(counters.undecodable_messages, " message is", " messages are",
      " truncated or contradictory and left out: correct the driver, or the type of the topic");
  add(counters.unreadable_scan_files, " scan file is", " scan files are",
      " truncated or damaged and left out: copy the recording again");
  add(counters.malformed_oxts_frames, " record of oxts is", " records of oxts are",
      " malformed and left out: copy the recording again");
  return findings;
}

bool is_damaged(const recording::Counters& counters) {
  return counters.damaged_parts + counters.unreadable_scan_files + counters.malformed_oxts_frames > 0;
}

std::string no_scan(const recording::Counters& counters) {
  std::string left_out;
  for (const auto& [count, what] :
       {std::pair{counters.undecodable_messages, "messages that cannot be decoded"},
        {counters.empty_scans, "scans without a point"},
        {counters.unreadable_scan_files, "damaged scan files"},
        {counters.incomplete_sweeps, "incomplete sweeps"}}) {
    if (count > 0) append_to_list(left_out, std::to_string(count) + " " + what);
  }
  return "no scan: " +
         (left_out.empty() ? "the LiDAR was off, or its topic or type is another (recording.topics)"
                           : "left out are " + left_out) +
         "; no map can be made of it";
}

}  // namespace fleetmap::apps
