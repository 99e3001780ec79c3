#include "fleetmap/messages/mission_report.hpp"

#include <algorithm>
#include <bit>

namespace fleetmap::messages {

const char* to_string(MissionState state) {
  switch (state) {
    case MissionState::kDriving:
      return "driving";
    case MissionState::kMeeting:
      return "meeting";
    case MissionState::kDone:
      return "done";
    case MissionState::kStuck:
      return "stuck";
    case MissionState::kLowBattery:
      return "low battery";
    case MissionState::kCalledHome:
      return "called home";
    case MissionState::kLost:
      return "lost";
  }
  return "unknown";
}

RowSet::RowSet(std::size_t rows, const Bytes& bytes) : RowSet(rows) {
  std::copy_n(bytes.begin(), std::min(bytes.size(), bytes_.size()), bytes_.begin());
  if (rows % 8 != 0 && !bytes_.empty()) {
    bytes_.back() = static_cast<std::uint8_t>(bytes_.back() & ((1u << (rows % 8)) - 1u));
  }
}

void RowSet::set(std::size_t row, bool value) {
  if (row / 8 >= bytes_.size()) return;
  const auto bit = static_cast<std::uint8_t>(1u << (row % 8));
  std::uint8_t& byte = bytes_[row / 8];
  byte = static_cast<std::uint8_t>(value ? byte | bit : byte & ~bit);
}

RowSet& RowSet::operator|=(const RowSet& other) {
  for (std::size_t k = 0; k < std::min(bytes_.size(), other.bytes_.size()); ++k) {
    bytes_[k] = static_cast<std::uint8_t>(bytes_[k] | other.bytes_[k]);
  }
  return *this;
}

RowSet& RowSet::operator&=(const RowSet& other) {
  for (std::size_t k = 0; k < bytes_.size(); ++k) {
    const std::uint8_t byte = k < other.bytes_.size() ? other.bytes_[k] : std::uint8_t{0};
    bytes_[k] = static_cast<std::uint8_t>(bytes_[k] & byte);
  }
  return *this;
}

bool RowSet::none() const {
  return std::ranges::all_of(bytes_, [](std::uint8_t byte) { return byte == 0; });
}

std::size_t RowSet::count() const {
  std::size_t sum = 0;
  for (const std::uint8_t byte : bytes_) sum += static_cast<std::size_t>(std::popcount(byte));
  return sum;
}

}  // namespace fleetmap::messages
