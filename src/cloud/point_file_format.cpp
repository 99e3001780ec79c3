#include "point_file_format.hpp"

#include <limits>

#include "fleetmap/core/lower_case.hpp"

namespace fleetmap::cloud {

Result<PointFileFormat> format_of(const std::filesystem::path& file) {
  const std::string extension = lower_case(file.extension().string());
  if (extension == ".ply") return PointFileFormat::ply;
  if (extension == ".pcd") return PointFileFormat::pcd;
  return failure("not a .ply or .pcd file");
}

std::string header_of(PointFileFormat format, std::size_t points, bool with_intensities,
                      std::span<const std::string> comments) {
  constexpr std::size_t kMaxDigits = std::numeric_limits<std::size_t>::digits10 + 1;
  const std::string count = std::to_string(points);
  std::string lines;
  for (const std::string& comment : comments)
    lines += (format == PointFileFormat::ply ? "\ncomment " : "\n# ") + comment;
  if (format == PointFileFormat::ply) {
    return "ply\nformat binary_little_endian 1.0\ncomment x y z in metres" +
           std::string(kMaxDigits - count.size(), ' ') + lines + "\nelement vertex " + count +
           "\nproperty float x\nproperty float y\nproperty float z\n" +
           (with_intensities ? "property float intensity\n" : "") + "end_header\n";
  }
  // The count occurs twice.
  return "# .PCD v0.7 - Point Cloud Data file format" + std::string(2 * (kMaxDigits - count.size()), ' ') +
         lines + "\nVERSION 0.7\n" +
         (with_intensities ? "FIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n"
                           : "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n") +
         "WIDTH " + count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
}

}  // namespace fleetmap::cloud
