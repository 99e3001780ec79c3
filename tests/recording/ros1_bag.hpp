#pragma once

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/bytes.hpp"

/// Parts of a ROS 1 bag, written by its specification.
namespace fleetmap::recording::testing {

inline std::string u32(std::uint32_t value) {
  std::string bytes;
  for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<char>(value >> (8 * k)));
  return bytes;
}
inline std::string time_of(std::uint64_t ns) {
  return u32(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
         u32(static_cast<std::uint32_t>(ns % 1'000'000'000));
}
inline std::string counted(const std::string& bytes) {
  return u32(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

using Fields = std::vector<std::pair<std::string, std::string>>;
inline std::string header(const Fields& fields) {
  std::string bytes;
  for (const auto& [name, value] : fields) bytes += counted(name + "=" + value);
  return bytes;
}
inline std::string record(const Fields& fields, const std::string& data) {
  return counted(header(fields)) + counted(data);
}

inline std::string connection(std::uint32_t id, const std::string& topic, const std::string& type) {
  return record({{"op", "\x07"}, {"conn", u32(id)}, {"topic", topic}},
                header({{"type", type}, {"md5sum", "*"}, {"message_definition", "x=y"}}));
}
inline std::string message(std::uint32_t connection_id, std::uint64_t ns, const std::string& data) {
  return record({{"op", "\x02"}, {"conn", u32(connection_id)}, {"time", time_of(ns)}}, data);
}
inline std::string index(std::uint32_t connection_id, const std::vector<std::uint64_t>& times) {
  std::string data;
  for (const std::uint64_t ns : times) data += time_of(ns) + u32(0);
  return record({{"op", "\x04"}, {"ver", u32(1)}, {"conn", u32(connection_id)}}, data);
}

inline std::string packed(const std::string& bytes, const std::string& compression) {
  if (compression == "none") return bytes;
  std::string out(bytes.size() + 100'000, '\0');
  if (compression == "bz2") {
    auto size = static_cast<unsigned>(out.size());
    std::string in = bytes;
    EXPECT_EQ(
        BZ2_bzBuffToBuffCompress(out.data(), &size, in.data(), static_cast<unsigned>(in.size()), 9, 0, 0),
        BZ_OK);
    out.resize(size);
  } else {
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  }
  return out;
}
inline std::string chunk(const std::string& records, const std::string& compression) {
  return record({{"op", "\x05"},
                 {"compression", compression},
                 {"size", u32(static_cast<std::uint32_t>(records.size()))}},
                packed(records, compression));
}

inline ByteView view(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

}  // namespace fleetmap::recording::testing
