#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

enum class NumberType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
std::size_t size_of(NumberType type);

/// Positions of the numbers in a PLY or PCD file, by its header.
struct PointFileLayout {
  enum class Encoding { ascii, little_endian, big_endian, compressed };
  struct Field {
    std::string name;
    NumberType type = NumberType::f32;
    std::size_t count = 1;   ///< numbers
    std::size_t offset = 0;  ///< bytes from the start of its point; in ascii, numbers
  };
  Encoding encoding = Encoding::ascii;
  std::vector<Field> fields;
  std::size_t stride = 0;  ///< bytes of a point; in ascii, numbers
  std::size_t points = 0;
  std::size_t body = 0;  ///< byte of the file at which the points begin
};

/// Reads the header at the start of `file` (the whole file's bytes). Fails, without naming the file, where
/// the header is malformed or promises more points than there are bytes for.
Result<PointFileLayout> pcd_layout(std::string_view file);
Result<PointFileLayout> ply_layout(std::string_view file);

}  // namespace fleetmap::cloud
