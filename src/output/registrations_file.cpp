#include "fleetmap/output/registrations_file.hpp"

#include <fstream>

namespace fleetmap::output {

Status append_registration(const std::filesystem::path& file, const RegistrationRow& row) {
  std::error_code error;
  const bool fresh = !std::filesystem::exists(file, error);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n";
  out << to_string(row.target) << ',' << to_string(row.source) << ',' << row.verdict << ',';
  if (row.fit) {
    out << row.fit->rmse << ',' << row.fit->inlier_fraction << ',' << row.fit->overlap << ',';
  } else {
    out << ",,,";
  }
  out << row.cpu_seconds << ",\"" << row.reason << "\"\n";
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

}  // namespace fleetmap::output
