#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/store/registration_log_config.hpp"

namespace fleetmap::store {

/// The relative pose that a registration began with; fields as in registration::Prior.
struct LoggedPrior {
  Pose T_target_source = Pose::Identity();
  double sigma_translation_m = 0.0;
  double sigma_yaw_rad = 0.0;
  double sigma_tilt_rad = 0.0;
  double sigma_height_m = 0.0;
  Eigen::Vector3d up_target = Eigen::Vector3d::UnitZ();
};

/// The inputs of one registration.
struct LoggedRegistration {
  NodeId target, source;
  std::string method;  ///< registration::to_string(Method)
  Bytes target_cloud;  ///< spherized, encoded, in base_link of its node
  Bytes source_cloud;
  LoggedPrior prior;
};

/// Name of the log in an agent's directory.
inline constexpr const char* kRegistrationLogFile = "registrations.db";

/// The last registrations that an agent ran, with both clouds, in one SQLite file beside the store: the same
/// loop candidates can be registered again by another method. A cloud that several registrations use is kept
/// once. The file stays within its bound, and one that is larger grows no more. One thread at a time.
class RegistrationLog {
 public:
  /// Opens the file to append to, and makes it where it is missing.
  static Result<RegistrationLog> open(const std::filesystem::path& file,
                                      const RegistrationLogConfig& config = {});
  static Result<RegistrationLog> open_read_only(const std::filesystem::path& file);
  RegistrationLog(RegistrationLog&&) noexcept;
  RegistrationLog& operator=(RegistrationLog&&) noexcept;
  ~RegistrationLog();

  /// The oldest are dropped where the file would exceed its bound.
  Status add(const LoggedRegistration& registration);
  /// All of them in the order in which they were added. Fails on a row that is damaged.
  Result<std::vector<LoggedRegistration>> read() const;

 private:
  struct State;
  explicit RegistrationLog(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::store
