#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::testing {

/// Reads what foxglove::CdrWriter wrote, by Fast CDR. Throws where the bytes end too early.
class CdrReader {
 public:
  explicit CdrReader(Bytes bytes)
      : bytes_(std::move(bytes)),
        buffer_(reinterpret_cast<char*>(bytes_.data()), bytes_.size()),
        cdr_(buffer_, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::Cdr::DDS_CDR) {
    cdr_.read_encapsulation();
  }

  template <class T>
  T number() {
    T value{};
    cdr_ >> value;
    return value;
  }
  std::uint32_t count() { return number<std::uint32_t>(); }
  bool flag() { return number<bool>(); }
  std::string text() { return number<std::string>(); }
  std::vector<double> numbers(std::size_t count) {
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k) values.push_back(number<double>());
    return values;
  }
  Bytes octets() {
    Bytes values(count());
    for (std::uint8_t& value : values) value = number<std::uint8_t>();
    return values;
  }
  bool at_end() const { return cdr_.getSerializedDataLength() == bytes_.size(); }

 private:
  Bytes bytes_;
  eprosima::fastcdr::FastBuffer buffer_;
  eprosima::fastcdr::Cdr cdr_;
};

}  // namespace fleetmap::testing
