#include "fleetmap/cloud/file_io.hpp"

#include <pcl/PCLPointCloud2.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>

#include "point_file_header.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> file_failure(const fs::path& file, const std::string& what) {
  return failure(file.string() + ": " + what);
}

enum class Format { ply, pcd };

Result<Format> format_of(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".ply") return Format::ply;
  if (extension == ".pcd") return Format::pcd;
  return file_failure(file, "not a .ply or .pcd file");
}

double value_at(const std::uint8_t* raw, std::uint8_t type) {
  const auto as = [raw](auto value) {
    std::memcpy(&value, raw, sizeof value);
    return static_cast<double>(value);
  };
  using Field = pcl::PCLPointField;
  switch (type) {
    case Field::INT8:
      return as(std::int8_t{});
    case Field::UINT8:
      return as(std::uint8_t{});
    case Field::INT16:
      return as(std::int16_t{});
    case Field::UINT16:
      return as(std::uint16_t{});
    case Field::INT32:
      return as(std::int32_t{});
    case Field::UINT32:
      return as(std::uint32_t{});
    case Field::FLOAT32:
      return as(float{});
    default:
      return as(double{});
  }
}

const pcl::PCLPointField* field_named(const pcl::PCLPointCloud2& blob, const std::string& name) {
  const auto found = std::find_if(blob.fields.begin(), blob.fields.end(),
                                  [&](const auto& field) { return field.name == name; });
  if (found == blob.fields.end() || found->datatype < pcl::PCLPointField::INT8 ||
      found->datatype > pcl::PCLPointField::FLOAT64 || found->count > 1 ||
      found->offset + static_cast<std::size_t>(pcl::getFieldSize(found->datatype)) > blob.point_step) {
    return nullptr;
  }
  return &*found;
}

Result<PointCloud> cloud_from(const pcl::PCLPointCloud2& blob, const fs::path& file) {
  const auto* x = field_named(blob, "x");
  const auto* y = field_named(blob, "y");
  const auto* z = field_named(blob, "z");
  if (x == nullptr || y == nullptr || z == nullptr)
    return file_failure(file, "has no numeric fields x, y, z");
  const auto* intensity = field_named(blob, "intensity");
  const std::size_t count = std::size_t{blob.width} * blob.height;
  if (blob.data.size() < count * blob.point_step) return file_failure(file, "truncated");
  PointCloud cloud;
  cloud.points.reserve(count);
  if (intensity != nullptr) cloud.intensities.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* point = blob.data.data() + i * blob.point_step;
    const auto get = [point](const pcl::PCLPointField& field) {
      return static_cast<float>(value_at(point + field.offset, field.datatype));
    };
    cloud.points.emplace_back(get(*x), get(*y), get(*z));
    if (intensity != nullptr) cloud.intensities.push_back(get(*intensity));
  }
  return cloud;
}

pcl::PCLPointCloud2 blob_from(const PointCloud& cloud) {
  pcl::PCLPointCloud2 blob;
  if (cloud.has_intensities()) {
    pcl::PointCloud<pcl::PointXYZI> points;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      pcl::PointXYZI point;
      point.getVector3fMap() = cloud.points[i];
      point.intensity = cloud.intensities[i];
      points.push_back(point);
    }
    pcl::toPCLPointCloud2(points, blob);
  } else {
    pcl::PointCloud<pcl::PointXYZ> points;
    for (const Eigen::Vector3f& p : cloud.points) points.emplace_back(p.x(), p.y(), p.z());
    pcl::toPCLPointCloud2(points, blob);
  }
  return blob;
}

}  // namespace

Result<PointCloud> read_cloud(const fs::path& file) {
  const auto format = format_of(file);
  if (!format) return failure(format.error().message);
  // PCL believes a header; a header that promises more than the file holds must not get that far.
  const auto sane = *format == Format::ply ? check_ply_header(file) : check_pcd_header(file);
  if (!sane) return file_failure(file, sane.error().message);
  pcl::PCLPointCloud2 blob;
  try {
    const int status = *format == Format::ply ? pcl::PLYReader().read(file.string(), blob)
                                              : pcl::PCDReader().read(file.string(), blob);
    if (status < 0) return file_failure(file, "damaged or truncated");
  } catch (const std::exception& error) {
    return file_failure(file, error.what());
  }
  return cloud_from(blob, file);
}

Status write_cloud(const fs::path& file, const PointCloud& cloud) {
  const auto format = format_of(file);
  if (!format) return failure(format.error().message);
  const fs::path part = file.string() + ".part";
  std::error_code error;
  try {
    const pcl::PCLPointCloud2 blob = blob_from(cloud);
    const int status = *format == Format::ply ? pcl::PLYWriter().writeBinary(part.string(), blob)
                                              : pcl::PCDWriter().writeBinary(part.string(), blob);
    if (status < 0) throw std::runtime_error("cannot be written");
    fs::rename(part, file);
  } catch (const std::exception& cause) {
    fs::remove(part, error);
    return file_failure(file, cause.what());
  }
  return {};
}

}  // namespace fleetmap::cloud
