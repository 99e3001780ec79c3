#include "geotiff_writer.hpp"

#include <dlfcn.h>

#include <system_error>

namespace fleetmap::output {
namespace {

Status geotiff_status(bool written, const std::string& error) {
  return written ? Status{} : Status(failure(error));
}

}  // namespace

std::filesystem::path GeoTiffWriter::module_file() {
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  return program.parent_path().parent_path() / "lib" / "fleetmap" / "libfleetmap_geotiff.so";
}

Result<GeoTiffWriter> GeoTiffWriter::load(const std::filesystem::path& module) {
  void* const library =
      dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);  // stays: GDAL keeps threads and caches
  if (library == nullptr) {
    return failure(module.string() + ": cannot be loaded (" + dlerror() +
                   "); GeoTIFF needs GDAL: install the package fleetmap-gis, or build with libgdal-dev");
  }
  GeoTiffWriter writer;
  writer.write_band_ = reinterpret_cast<WriteGeoTiffBand>(dlsym(library, kWriteGeoTiffBand));
  writer.write_hillshade_ = reinterpret_cast<WriteHillshade>(dlsym(library, kWriteHillshade));
  if (writer.write_band_ == nullptr || writer.write_hillshade_ == nullptr)
    return failure(module.string() + ": is of another version of fleetmap; install both anew");
  return writer;
}

Status GeoTiffWriter::write(const GeoTiffBand& band) const {
  std::string error;
  const bool written = write_band_(band, error);
  return geotiff_status(written, error);
}

Status GeoTiffWriter::write_hillshade(const std::filesystem::path& heights,
                                      const std::filesystem::path& file) const {
  std::string error;
  const bool written = write_hillshade_(heights.string(), file.string(), error);
  return geotiff_status(written, error);
}

}  // namespace fleetmap::output
